// From a live session to a checkpoint: its committed levels, described by spans into the windows, and the plug-ins that
// made them. Nothing is copied here; the bytes of the file are built from this in one go, between two steps.
#pragma once

#include "io/checkpoint.hpp"
#include "run/session.hpp"
#include "run/step_clock.hpp"

#include <map>
#include <string>
#include <vector>

namespace mullion::run {

/// The plug-ins of a case as a checkpoint names them: the build is a checksum of the library's file.
/// @param checksums  by path, those known so far
[[nodiscard]] std::vector<io::CheckpointPlugin> plugins_of(const Case& the_case,
                                                           std::map<std::string, std::string>& checksums);

/// One text for each plug-in that is not the one of then: "fluid: gas 0.2.0, was 0.1.0".
[[nodiscard]] std::vector<std::string> other_plugins(const std::vector<io::CheckpointPlugin>& then,
                                                     const std::vector<io::CheckpointPlugin>& now);

/// All that the session and the clock know of the last commit. Valid until the next one.
[[nodiscard]] io::Checkpoint checkpoint_of(Session& session, const StepClock& clock);

} // namespace mullion::run
