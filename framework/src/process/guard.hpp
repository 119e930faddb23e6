// The guard: the process that the user started. It forks the orchestrator before any thread exists, passes on the
// terminal's signals, waits, and whatever happens to the orchestrator it sees to it that no host is left, that the
// culprit is named, and that the exit code is right.
//
// Reads the control object, writes nothing shared. When the guard dies, the kernel kills the orchestrator
// (PDEATHSIG), and with it the hosts.
#pragma once

#include "shm/control.hpp"

#include <functional>

namespace mullion::process {

/// What the orchestrator does: gets the control object (read-write) and its descriptor, returns the exit code.
using Orchestrator = std::function<int(shm::Control& control, int control_fd)>;

/// Fork, run, wait. @return the exit code of the run
int run_guarded(const Orchestrator& orchestrator);

} // namespace mullion::process
