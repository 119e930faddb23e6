// Does a module fit the windows of a live run that another one made? Declarations against the schemas that are there:
// nothing of the candidate runs for this.
#pragma once

#include "shm/window_map.hpp"

#include <mullion/sdk/abi.h>

#include <string>

namespace mullion::run {

/// @param module  number of the module whose windows the candidate would take over
/// @returns what does not fit, all of it, with ";" in between; "" if everything does
std::string misfit(const mullion_module& candidate, std::uint32_t module, shm::WindowMap& windows);

} // namespace mullion::run
