// How far a run is: on a terminal one line with rate and remaining time, ten times a second; elsewhere a log line
// every ten seconds.
#pragma once

#include "run/timings.hpp"

#include <mullion/sdk/window.hpp>

namespace mullion::run {

class Progress {
public:
  Progress();
  /// @param n_steps  how many there will be, as far as is known now
  void show(const TimeStep& done, std::int64_t n_steps);

private:
  std::int64_t first_step_ = -1;
  Clock::time_point begin_, next_;
  std::int64_t next_look_ = 0;
  Clock::duration interval_;
};

} // namespace mullion::run
