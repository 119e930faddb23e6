// How far a run is: on a terminal one line with rate and remaining time, ten times a second; elsewhere a log line
// every ten seconds.
#pragma once

#include "run/timings.hpp"

#include <mullion/sdk/window.hpp>

#include <atomic>
#include <cstdint>

namespace mullion::run {

class Progress {
public:
  /// @param n_steps  planned; it may change on the way
  explicit Progress(const std::atomic<std::int64_t>& n_steps);
  void show(const TimeStep& done);

private:
  const std::atomic<std::int64_t>& n_steps_;
  std::int64_t first_step_ = -1;
  Clock::time_point begin_, next_;
  std::int64_t next_look_ = 0;
  Clock::duration interval_;
};

} // namespace mullion::run
