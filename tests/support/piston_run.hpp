// The closed piston of configs/closed_piston.toml as `mullion run` does it, with other numbers: inline, without result
// files, from a mode of the coupled problem or from the load step. What the verification of all schemes starts from.
#pragma once

#include "support/exact_piston.hpp"
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <string>
#include <vector>

namespace mullion::test {

inline constexpr double mode_amplitude = 1e-6; ///< of a start in a mode [m]: relative nonlinearity 1e-6

enum class Start {
  mode,     ///< the first closed mode at its turning point; p_ref = p_0, no load step
  load_step ///< at rest; p_ref = p_0 - piston.dp
};

struct PistonRun {
  testing::Piston piston{};
  int cells = 50;
  double dt = 0.0;  ///< coupling step [s]
  double end = 0.0; ///< last time as f_f t
  Start start = Start::mode;
  std::vector<std::string> sets{}; ///< "driver.profile=linear"; later ones override
};

/// The step in which a sound wave crosses this part of a cell [s].
[[nodiscard]] double courant_step(const testing::Piston& piston, int cells, double courant);
/// Whole steps to the end.
[[nodiscard]] int n_steps(const PistonRun& run);
/// As the command line takes it.
[[nodiscard]] CaseRun case_run(const PistonRun& run);

struct PistonResult {
  History history; ///< empty unless the run completed
  int exit_code = 0;
  std::string out, err;
};
[[nodiscard]] PistonResult try_run(const PistonRun& run);
/// history.csv of a run that must complete.
[[nodiscard]] History history_of(const PistonRun& run);

/// Slope of the least-squares line through ln sqrt(u^2 + (v / w)^2) over f_f t, for a run that started in a mode.
[[nodiscard]] double growth_rate(const History& history, const testing::Piston& piston);
/// Growth per unit of f_f t that a net lag of one coupling step makes of the first mode, by the lag law.
[[nodiscard]] double growth_per_step_of_lag(const PistonRun& run);

/// Standard deviation in windows of `width` (f_f t), one after the other; what is left at the end is left out.
[[nodiscard]] std::vector<double> windowed_deviation(const History& history, const std::string& column,
                                                     const testing::Piston& piston, double width);

} // namespace mullion::test
