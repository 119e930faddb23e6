// The coupling steps of a run. Their times are computed here, once; nobody recomputes them.
#pragma once

#include <mullion/app/case_file.hpp>
#include <mullion/sdk/error.hpp>
#include <mullion/sdk/window.hpp>

#include <cmath>

namespace mullion::run {

/// t_n = start + n dt, and the last step is shortened to end at end_time exactly.
class TimePlan {
public:
  TimePlan(const Case& c, bool needs_constant_step) : start_(c.start_time), end_(c.end_time), dt_(c.dt)
  {
    const double steps = (end_ - start_) / dt_;
    MULLION_REQUIRE(steps < 1e15, Errc::config, "run.dt = {} s makes {:g} steps until {} s", dt_, steps, end_);
    n_steps_ = static_cast<std::int64_t>(std::ceil(steps - 1e-9)); // a remainder of 1e-9 dt is round-off
    if (n_steps_ < 1) n_steps_ = 1;
    const double remainder = std::abs(start_ + static_cast<double>(n_steps_) * dt_ - end_);
    MULLION_REQUIRE(
        !needs_constant_step || remainder <= 1e-9 * dt_, Errc::config,
        "driver {} cannot take a shortened step, but run.end_time = {} s is no whole number of steps of {} s; "
        "{} s would be",
        c.scheme, end_, dt_, start_ + static_cast<double>(n_steps_) * dt_);
  }
  [[nodiscard]] std::int64_t n_steps() const { return n_steps_; }
  [[nodiscard]] double time(std::int64_t n) const
  {
    return n >= n_steps_ ? end_ : start_ + static_cast<double>(n) * dt_;
  }
  /// @param index 1 for the first
  [[nodiscard]] TimeStep step(std::int64_t index) const
  {
    const double begin = time(index - 1), end = time(index);
    const bool is_regular = std::abs(end - begin - dt_) <= 1e-9 * dt_;
    return {index, begin, end, is_regular ? dt_ : end - begin, 0};
  }

private:
  double start_, end_, dt_;
  std::int64_t n_steps_ = 0;
};

} // namespace mullion::run
