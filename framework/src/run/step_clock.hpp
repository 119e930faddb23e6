// Where a run stands among its steps. The plan's steps are whole ones; one that diverges may be done in parts instead,
// two halves, four quarters, …, so that the run comes back to the plan's times exactly. The clock counts the steps that
// are committed, whole or not, and says which comes next. It stands in every checkpoint.
#pragma once

#include "io/checkpoint.hpp"
#include "run/time_plan.hpp"

#include <mullion/sdk/window.hpp>

#include <cstdint>

namespace mullion::run {

class StepClock {
public:
  explicit StepClock(TimePlan plan) : plan_(plan) {}
  /// Go on from a checkpoint. If the case has another dt or end than it had then, times are counted from there.
  /// @throws Error Errc::config as TimePlan
  StepClock(const Case& c, bool needs_constant_step, const io::CheckpointClock& from);

  [[nodiscard]] bool is_at_end() const { return grid_ >= plan_.n_steps(); }
  /// The step that comes next: its index counts committed steps.
  [[nodiscard]] TimeStep next() const;
  /// The next step was committed.
  void advance();
  /// The next step failed: halve it, at most `most` times. @return false if that is not allowed any more
  [[nodiscard]] bool halve(std::int64_t most);

  /// Steps committed so far, and how many there will be if none is halved from here on.
  [[nodiscard]] std::int64_t step() const { return step_; }
  [[nodiscard]] std::int64_t n_steps() const { return step_ + (plan_.n_steps() - grid_); }
  /// Whole steps done, and does the run stand at the end of one?
  [[nodiscard]] std::int64_t grid() const { return grid_; }
  [[nodiscard]] bool is_on_grid() const { return n_parts_ == 0; }
  [[nodiscard]] double time() const { return part_time(n_parts_); }
  /// Is this (earlier) time the end of a whole step, as times are counted now?
  [[nodiscard]] bool is_whole(double time) const;

  [[nodiscard]] io::CheckpointClock state() const;

private:
  /// After so many good steps in a row a halved step is doubled again, where the parts fit. Each failure doubles the
  /// patience: what diverges slowly has spoilt the state before it is noticed, and ever new tries spoil it more.
  static constexpr std::int64_t least_patience = 8, most_patience = 4096;
  [[nodiscard]] double part_time(std::int64_t part) const;

  TimePlan plan_;
  std::int64_t step_ = 0, grid_ = 0;
  std::int64_t n_halvings_ = 0; ///< whole steps are divided into 2^n_halvings parts
  std::int64_t n_parts_ = 0;    ///< of them done
  std::int64_t n_good_ = 0;     ///< since the last change
  std::int64_t patience_ = least_patience;
};

} // namespace mullion::run
