// Hosts of a live run that are disturbed until another takes their place, which `run.on_failure = "respawn"` promises.
#pragma once

#include "support/run_case.hpp"

#include <functional>

namespace mullion::test {

/// Disturb the host of each module of the live long piston, one after the other, ten steps apart, and wait for the one
/// that replaces it; then for ten steps more.
void replace_each_host(const RunFolder& folder, const std::function<void(pid_t host)>& disturb);

} // namespace mullion::test
