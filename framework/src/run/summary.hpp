// The short text at the end of a run: what happened, the measured interface quantities beside the expected ones,
// where the time went, where the results are.
#pragma once

#include "run/recorder.hpp"

#include <string>

namespace mullion::run {

/// @param stopped_by why the run ended early, or ""
std::string summary(const Recorder& recorder, const std::string& stopped_by);

} // namespace mullion::run
