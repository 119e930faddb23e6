// What every command does that lets modules work: under a guard process, with whatever is thrown turned into one
// message on standard error and an exit code.
#pragma once

#include "process/guard.hpp"

#include <string>

namespace mullion::run {

/// @param log_level  debug, info, warning, error or off
/// @return           what `body` returned; 2 where it threw that the command or the case is wrong, 1 for all else
/// @throws Error     Errc::config: there is no such level
int under_guard(const std::string& log_level, const process::Orchestrator& body);

} // namespace mullion::run
