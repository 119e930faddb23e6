// The faulty piston as a run that is steered from outside: long, and compared with one that nobody disturbed.
#pragma once

#include "support/run_case.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace mullion::test {

/// Start it afresh in the folder's "out" and wait until it is at work. It is long enough to be disturbed a dozen times
/// even inline, where a step takes some microseconds.
std::unique_ptr<Process> live_piston(const RunFolder& folder, const std::vector<std::string>& flags,
                                     const std::vector<std::string>& sets = {});
/// Results of the same without disturbance, made once a process.
std::filesystem::path whole_piston();
/// End the live run, whose results must be the first part of the undisturbed run's.
void check_undisturbed(const RunFolder& folder, Process& run);
/// What was done to the run, by its record: "swap fluid", "set driver".
std::vector<std::string> events(const RunFolder& folder);

} // namespace mullion::test
