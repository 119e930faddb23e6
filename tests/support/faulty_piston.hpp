// The closed piston with a structure that misbehaves on request (tests/process/faulty_piston.toml), and what every
// ended run must have in common, however it ended.
#pragma once

#include "support/run_case.hpp"

#include <string>
#include <vector>

namespace mullion::test {

inline constexpr const char* piston_name = "faulty"; ///< of the run
inline constexpr const char* instances[] = {"fluid", "structure", "mesh_motion", "transfer"};

/// 60 steps, each module in a process.
CaseRun piston(const std::vector<std::string>& sets = {}, const std::vector<std::string>& flags = {});
/// The same with 20,000 steps, a result file every 1000: long enough to be disturbed.
CaseRun long_piston(const std::vector<std::string>& sets = {}, const std::vector<std::string>& flags = {});
/// Do the long one without disturbance, inline (which gives the same bytes sooner), into the folder "whole".
void run_whole(const RunFolder& folder, const std::vector<std::string>& sets = {});

bool has(const std::string& text, const std::string& part);
/// Lines of standard error that start with "mullion: error: ", without that.
std::vector<std::string> error_messages(const ProcessResult& result);

/// The run failed and said so: exit code, one error message that holds all the parts, a record that agrees; nobody and
/// nothing left.
void check_failed(const RunFolder& folder, const ProcessResult& result, int exit_code,
                  const std::vector<std::string>& parts);
/// Within a second of now no process of any run is left, and /dev/shm is as it was.
void check_nothing_left(const RunFolder& folder);

/// Wait for the orchestrator of a guard, or for the host of a module (0 fluid, 1 structure, …). @return 0: none came
pid_t find_orchestrator(const RunFolder& folder, pid_t guard);
pid_t find_host(const RunFolder& folder, int module);

} // namespace mullion::test
