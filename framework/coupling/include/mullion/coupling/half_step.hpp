// The clock of a fluid that runs half a step behind the structure, for schemes that interleave the two like a
// leap-frog: in the coupling step from t^n to t^{n+1} the fluid advances over a window around t^n,
//
//     [t^n - dt_{n-1}/2, t^n + dt_n/2]
//
// A fluid that has an exact state at t0 - dt/2 starts there; any other starts at t0, and its first window is
// [t0, t0 + dt/2].
#pragma once

#include <mullion/coupling/driver.hpp>

namespace mullion {

class HalfStepClock {
public:
  static constexpr auto meaning =
      "the fluid's first state belongs to half a step before the start (initial = \"mode\" knows it); otherwise its "
      "first window is half a step long";

  /// @param starts_early  the fluid's first state belongs to t0 - dt/2
  void define(Wiring& wiring, bool starts_early, const std::vector<std::string>& instances)
  {
    starts_early_ = starts_early;
    wiring.state_numbers("previous_dt", 1);
    if (starts_early)
      for (const auto& instance : instances) wiring.offset_clock(instance, -0.5);
  }
  void attach(const Coupling& coupling) { previous_dt_ = coupling.state("previous_dt"); }
  void start(const TimeStep& initial) const { previous_dt_.now()(0, 0) = starts_early_ ? initial.dt : 0.0; }

  /// The fluid's window in this coupling step.
  [[nodiscard]] TimeStep window(const TimeStep& step) const
  {
    const double previous = previous_dt_.committed()(0, 0);
    const double dt = previous == step.dt ? step.dt : 0.5 * (previous + step.dt); // equal steps: the same bits
    return {step.index, step.begin - 0.5 * previous, step.begin + 0.5 * step.dt, dt, step.iteration};
  }
  /// dt_{n-1}; in the first step this one's [s].
  [[nodiscard]] double previous_dt(const TimeStep& step) const
  {
    const double previous = previous_dt_.committed()(0, 0);
    return previous > 0.0 ? previous : step.dt;
  }
  void end_step(const TimeStep& step) const { previous_dt_.now()(0, 0) = step.dt; }

private:
  bool starts_early_ = false;
  DriverField previous_dt_; ///< dt_{n-1} [s]
};

} // namespace mullion
