#include "run/step_clock.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>

namespace mullion::run {
namespace {

TimePlan plan_of(const Case& c, bool needs_constant_step, const io::CheckpointClock& from)
{
  MULLION_REQUIRE(0 <= from.grid && from.grid <= from.step && 0 <= from.n_halvings && from.n_halvings < 62 &&
                      0 <= from.n_parts && from.n_parts < std::int64_t{1} << from.n_halvings,
                  Errc::io, "the checkpoint's clock is damaged: {} steps, {} whole ones, {} parts of 2^{}", from.step,
                  from.grid, from.n_parts, from.n_halvings);
  MULLION_REQUIRE(from.time <= c.end_time, Errc::config,
                  "the checkpoint holds the state at t = {} s, behind run.end_time = {} s; expected a later end",
                  from.time, c.end_time);
  const TimePlan plan(c, needs_constant_step, {from.origin, from.origin_time});
  const bool is_the_same = c.dt == from.dt && from.grid <= plan.n_steps() && plan.time(from.grid) == from.grid_time &&
                           (from.n_parts == 0 || plan.time(from.grid + 1) == from.next_time);
  return is_the_same ? plan : TimePlan(c, needs_constant_step, {from.grid, from.time});
}

} // namespace

StepClock::StepClock(const Case& c, bool needs_constant_step, const io::CheckpointClock& from)
    : plan_(plan_of(c, needs_constant_step, from)), step_(from.step), grid_(from.grid)
{
  const bool is_the_same = plan_.origin().step == from.origin && plan_.origin().time == from.origin_time;
  if (!is_the_same) return;
  n_halvings_ = from.n_halvings;
  n_parts_ = from.n_parts;
  n_good_ = from.n_good;
  patience_ = from.patience;
}

double StepClock::part_time(std::int64_t part) const
{
  const double begin = plan_.time(grid_), end = plan_.time(grid_ + 1);
  if (part == 0) return begin;
  if (part == std::int64_t{1} << n_halvings_) return end;
  return begin + std::ldexp(static_cast<double>(part), -static_cast<int>(n_halvings_)) * (end - begin);
}

TimeStep StepClock::next() const
{
  auto step = plan_.step(grid_ + 1);
  step.index = step_ + 1;
  if (n_halvings_ == 0) return step;
  step.begin = part_time(n_parts_);
  step.end = part_time(n_parts_ + 1);
  step.dt = std::ldexp(step.dt, -static_cast<int>(n_halvings_)); // exact
  return step;
}

void StepClock::advance()
{
  ++step_;
  ++n_good_;
  if (++n_parts_ == std::int64_t{1} << n_halvings_) {
    n_parts_ = 0;
    ++grid_;
  }
  if (n_halvings_ == 0 || n_good_ < patience_ || n_parts_ % 2 != 0) return;
  --n_halvings_;
  n_parts_ /= 2;
  n_good_ = 0;
}

bool StepClock::is_whole(double time) const
{
  const auto origin = plan_.origin();
  const double n = std::round((time - origin.time) / plan_.dt());
  return n >= 0.0 && std::abs(time - (origin.time + n * plan_.dt())) <= 1e-9 * plan_.dt(); // less is round-off
}

bool StepClock::halve(std::int64_t most)
{
  if (n_halvings_ >= most) return false;
  ++n_halvings_;
  n_parts_ *= 2;
  n_good_ = 0;
  patience_ = std::min(2 * patience_, most_patience);
  return true;
}

io::CheckpointClock StepClock::state() const
{
  io::CheckpointClock state;
  state.step = step_;
  state.time = time();
  state.dt = plan_.dt();
  state.grid = grid_;
  state.grid_time = plan_.time(grid_);
  state.next_time = plan_.time(grid_ + 1);
  state.origin = plan_.origin().step;
  state.origin_time = plan_.origin().time;
  state.n_halvings = n_halvings_;
  state.n_parts = n_parts_;
  state.n_good = n_good_;
  state.patience = patience_;
  return state;
}

} // namespace mullion::run
