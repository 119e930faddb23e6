// The coupling steps of a run. Their times are computed here, once; nobody recomputes them.
#pragma once

#include <mullion/app/case_file.hpp>
#include <mullion/sdk/error.hpp>
#include <mullion/sdk/window.hpp>

#include <cmath>

namespace mullion::run {

/// The whole step from which times are counted: step 0 at the start, or where a restarted run left its old plan.
struct TimeOrigin {
  std::int64_t step = 0;
  double time = 0.0; ///< [s]
};

/// t_n = start + n dt, and the last step is shortened to end at end_time exactly.
class TimePlan {
public:
  TimePlan(const Case& c, bool needs_constant_step) : TimePlan(c, needs_constant_step, {0, c.start_time}) {}
  /// @throws Error Errc::config: too many steps, a last one that the driver cannot take, an end before the origin
  TimePlan(const Case& c, bool needs_constant_step, TimeOrigin origin)
      : origin_(origin), end_(c.end_time), dt_(c.dt), n_steps_(origin.step)
  {
    MULLION_REQUIRE(origin.time <= end_, Errc::config, "the run is at t = {} s already, and run.end_time = {} s",
                    origin.time, end_);
    const double steps = (end_ - origin.time) / dt_;
    MULLION_REQUIRE(steps < 1e15, Errc::config, "run.dt = {} s makes {:g} steps until {} s", dt_, steps, end_);
    n_steps_ += static_cast<std::int64_t>(std::ceil(steps - 1e-9)); // a remainder of 1e-9 dt is round-off
    if (n_steps_ < 1) n_steps_ = 1;
    const double remainder = std::abs(origin.time + static_cast<double>(n_steps_ - origin.step) * dt_ - end_);
    MULLION_REQUIRE(
        !needs_constant_step || remainder <= 1e-9 * dt_, Errc::config,
        "driver {} cannot take a shortened step, but run.end_time = {} s is no whole number of steps of {} s; "
        "{} s would be",
        c.scheme, end_, dt_, origin.time + static_cast<double>(n_steps_ - origin.step) * dt_);
  }
  [[nodiscard]] std::int64_t n_steps() const { return n_steps_; }
  [[nodiscard]] TimeOrigin origin() const { return origin_; }
  [[nodiscard]] double dt() const { return dt_; }
  [[nodiscard]] double time(std::int64_t n) const
  {
    return n >= n_steps_ ? end_ : origin_.time + static_cast<double>(n - origin_.step) * dt_;
  }
  /// @param index 1 for the first
  [[nodiscard]] TimeStep step(std::int64_t index) const
  {
    const double begin = time(index - 1), end = time(index);
    const bool is_regular = std::abs(end - begin - dt_) <= 1e-9 * dt_;
    return {index, begin, end, is_regular ? dt_ : end - begin, 0};
  }

private:
  TimeOrigin origin_;
  double end_, dt_;
  std::int64_t n_steps_;
};

} // namespace mullion::run
