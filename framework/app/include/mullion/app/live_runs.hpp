// The runs that are alive on this machine, of this user: list them, ask them, change them.
#pragma once

#include <string>
#include <vector>

namespace mullion {

struct LiveRun {
  std::string name;
  long pid = 0;
  long long step = 0, n_steps = 0;
  double time = 0.0;
  std::string problem; ///< why it did not answer; "" if it did
};

/// All live runs, by name. Leftovers of dead ones are removed.
std::vector<LiveRun> list_live_runs();

/// Ask a live run to end cleanly at the next step boundary.
/// @throws Error Errc::config: no such run (with the live ones)
void stop_run(const std::string& name);

/// What a change of a live run came to.
struct ChangeOutcome {
  std::string text;   ///< what was done
  long long step = 0; ///< the first step with it
};

/// Put other code in the place of a module at the next step boundary, and wait until its first step is committed.
/// @param target  instance or kind
/// @param plugin  name of a plug-in, or path of a library (with a '/')
/// @param sets    its parameters, "youngs_modulus=7e10"
/// @throws Error Errc::config, Errc::plugin: refused, the run goes on undisturbed; Errc::process: its first step failed
///         and what was there before did that step again, or the run ended
ChangeOutcome swap_module(const std::string& name, const std::string& target, const std::string& plugin,
                          const std::vector<std::string>& sets);

/// Change parameters of one table in a live run: those that a module or the driver declares as changeable
/// ("structure.youngs_modulus=7e10", "driver.kappa=0.3"), run.end_time, output.every. Waits and throws as swap_module.
ChangeOutcome set_parameters(const std::string& name, const std::vector<std::string>& sets);

/// Ask a live run for a checkpoint; returns when it is written.
ChangeOutcome request_checkpoint(const std::string& name);

} // namespace mullion
