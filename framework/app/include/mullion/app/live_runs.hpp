// The runs that are alive on this machine, of this user: list them, ask them.
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

} // namespace mullion
