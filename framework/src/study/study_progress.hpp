// How far a study is, in one line for all of its runs: on a terminal ten times a second, elsewhere a log line every ten
// seconds.
#pragma once

#include <chrono>
#include <cstddef>

namespace mullion::study {

struct Counts {
  std::size_t n_runs = 0, n_before = 0; ///< all; those that an earlier session has done
  std::size_t n_done = 0, n_failed = 0, n_running = 0;
};

class Progress {
public:
  Progress();
  void show(const Counts& counts);

private:
  using Clock = std::chrono::steady_clock;
  Clock::duration interval_;
  Clock::time_point begin_ = Clock::now(), next_ = begin_;
};

} // namespace mullion::study
