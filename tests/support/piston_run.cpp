// Runs of the closed piston through the command line, and the measures of their histories.
#include "support/piston_run.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mullion::test {

double courant_step(const testing::Piston& piston, int cells, double courant)
{
  return courant * piston.fluid_length / cells / piston.fluid_speed();
}

int n_steps(const PistonRun& run)
{
  return static_cast<int>(std::lround(run.end / (run.dt * run.piston.fluid_frequency())));
}

CaseRun case_run(const PistonRun& run)
{
  const auto& piston = run.piston;
  CaseRun result;
  result.file = MULLION_SOURCE_DIR "/configs/closed_piston.toml";
  result.flags = {"--inline"};
  result.timeout = std::chrono::minutes(10); // the longest take seconds, if nobody else wants the cores
  const auto set = [&](const std::string& key, const auto& value) {
    result.sets.push_back(fmt::format("{}={}", key, value));
  };
  set("run.dt", run.dt);
  set("run.end_time", n_steps(run) * run.dt);
  set("fluid.cells", run.cells);
  set("structure.density", piston.solid_density());
  set("structure.youngs_modulus", piston.youngs_modulus());
  set("structure.length", piston.solid_length());
  set("structure.elements", std::max(1L, std::lround(piston.solid_length() * run.cells)));
  if (run.start == Start::mode)
    for (const std::string module : {"fluid", "structure"}) {
      set(module + ".initial", "mode");
      set(module + ".mode_amplitude", mode_amplitude);
      set(module + ".mode_angular_frequency", closed_frequencies(piston, 1)[0]);
    }
  set("coupling.reference_pressure", run.start == Start::mode ? piston.p0 : piston.p0 - piston.dp);
  set("output.every", 0);
  set("expect", "[]");
  result.sets.insert(result.sets.end(), run.sets.begin(), run.sets.end());
  return result;
}

PistonResult try_run(const PistonRun& run)
{
  const RunFolder folder;
  const auto result = folder.run(case_run(run));
  const bool has_completed = result.exit_code == 0;
  return {has_completed ? read_history(folder / "out/history.csv") : History{}, result.exit_code, result.out,
          result.err};
}

History history_of(const PistonRun& run)
{
  auto result = try_run(run);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return std::move(result.history);
}

double growth_rate(const History& history, const testing::Piston& piston)
{
  const double omega = closed_frequencies(piston, 1)[0];
  const auto& u = history.at("structure.wet.displacement");
  const auto& v = history.at("structure.wet.velocity");
  double n = 0, sum_t = 0, sum_y = 0, sum_tt = 0, sum_ty = 0;
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double t = history.at("time")[i] * piston.fluid_frequency();
    const double y = std::log(std::hypot(u[i], v[i] / omega) / mode_amplitude);
    n += 1, sum_t += t, sum_y += y, sum_tt += t * t, sum_ty += t * y;
  }
  return (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
}

double growth_per_step_of_lag(const PistonRun& run)
{
  return lag_growth_rate(run.piston, closed_frequencies(run.piston, 1)[0], run.dt) / run.piston.fluid_frequency();
}

std::vector<double> windowed_deviation(const History& history, const std::string& column, const testing::Piston& piston,
                                       double width)
{
  const auto& times = history.at("time");
  const auto& values = history.at(column);
  std::vector<double> result;
  std::size_t begin = 0;
  for (std::size_t end = 0; end <= times.size(); ++end) {
    const double limit = static_cast<double>(result.size() + 1) * width;
    const bool is_full = end == times.size() ? times.back() * piston.fluid_frequency() > limit * (1.0 - 1e-9)
                                             : times[end] * piston.fluid_frequency() > limit * (1.0 + 1e-9);
    if (!is_full) continue;
    double mean = 0.0, squares = 0.0;
    for (std::size_t i = begin; i < end; ++i) mean += values[i];
    mean /= static_cast<double>(end - begin);
    for (std::size_t i = begin; i < end; ++i) squares += (values[i] - mean) * (values[i] - mean);
    result.push_back(std::sqrt(squares / static_cast<double>(end - begin)));
    begin = end;
  }
  return result;
}

} // namespace mullion::test
