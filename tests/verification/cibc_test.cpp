// Combined interface boundary conditions: the bound of the weight above which grid-scale noise blows up, what a run
// says about a weight beyond it, and that both corrections damp with the signs that the scheme has, and only with
// those.
#include "support/coupled_piston.hpp"
#include "support/piston_run.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace mullion::test;
using mullion::testing::CibcWeights;
using mullion::testing::CoupledPiston;
using mullion::testing::Piston;
using mullion::testing::worst;

namespace {

/// The load step at a Courant number of 0.1 with the weight kappa = omega c.
PistonRun with_weight(double kappa, double end, const std::vector<std::string>& sets)
{
  PistonRun run{.cells = 40, .dt = courant_step({}, 40, 0.1), .end = end, .start = Start::load_step};
  run.sets = {"driver.scheme=cibc", fmt::format("driver.fluid_density={}", run.piston.rho0),
              fmt::format("driver.sound_speed={}", run.piston.fluid_speed()), fmt::format("driver.kappa={}", kappa)};
  run.sets.insert(run.sets.end(), sets.begin(), sets.end());
  return run;
}

double largest_displacement(const History& history)
{
  double largest = 0.0;
  for (const double u : history.at("structure.wet.displacement")) largest = worst(largest, std::abs(u));
  return largest;
}

// Strong feedback: mu = 100, f_r = 0.97, Courant number 0.3, kappa = 0.45, starting in the first mode.
const Piston strong_feedback{.density_ratio = 100.0, .frequency_numerator = 97, .frequency_denominator = 100};
constexpr int feedback_cells = 40;
constexpr double feedback_kappa = 0.45;

/// First f_f t at which |u_I| is beyond 1e-4 m, a hundred times the start; none until 5: 5.
double time_of_blow_up(double velocity_sign, double traction_sign)
{
  const double dt = courant_step(strong_feedback, feedback_cells, 0.3);
  const double omega = feedback_kappa / strong_feedback.fluid_speed();
  CoupledPiston loop(strong_feedback, feedback_cells, dt);
  double t = 0.0;
  while (t < 5.0 && std::abs(loop.u()) <= 1e-4) {
    loop.cibc({velocity_sign * omega, traction_sign * omega});
    t += dt * strong_feedback.fluid_frequency();
  }
  return t;
}

} // namespace

TEST_CASE("cibc is stable for weights below its upper bound and blows up above, its half-offset form at none")
{
  // Grid-scale noise: with the cells frozen the scheme's recursion for the wall velocity is marginal at kappa = 1/2 +
  // 4/3 C = 0.633 for C = 0.1. What must not blow up stays near the amplitude of the exact solution, 0.014 m.
  const auto largest = [](double kappa, const std::vector<std::string>& sets) {
    return largest_displacement(history_of(with_weight(kappa, 40.0, sets)));
  };
  CHECK(largest(0.3, {}) < 0.02);
  CHECK(largest(0.55, {}) < 0.02);
  CHECK(largest(3.0, {"driver.half_offset=true"}) < 0.02);

  const auto blown_up = try_run(with_weight(0.75, 5.0, {"driver.omega_check=warn"}));

  CAPTURE(blown_up.err);
  CHECK(blown_up.exit_code == 1);
  CHECK(blown_up.err.find("cell ") != std::string::npos);                                           // the gas's fault,
  CHECK(blown_up.err.find("cibc is stable for weights within a window only") != std::string::npos); // and its reason
}

TEST_CASE("a weight outside of its window is refused at the start, with the bounds")
{
  const auto refused = try_run(with_weight(0.75, 5.0, {}));

  CHECK(refused.exit_code == 2);
  CAPTURE(refused.err);
  CHECK(refused.err.find("kappa = omega c = 0.75") != std::string::npos);
  CHECK(refused.err.find("<= kappa <= 0.6333") != std::string::npos); // 1/2 + 4/3 0.1
  CHECK(refused.err.find("omega_check") != std::string::npos);

  const auto warned = try_run(with_weight(0.75, 0.1, {"driver.omega_check=warn"}));
  CHECK(warned.exit_code == 0);
  CHECK(warned.err.find("<= kappa <= 0.6333") != std::string::npos);
}

TEST_CASE("a step that is too long for the consistent reading is refused, with the form that can do it")
{
  auto run = with_weight(0.4, 1.0, {"fluid.substeps=4"}); // substeps don't help: the correction sees coupling steps
  run.dt *= 4.0;

  const auto refused = try_run(run);
  CAPTURE(refused.err);
  CHECK(refused.exit_code == 2);
  CHECK(refused.err.find("c dt/dx <= 0.3") != std::string::npos);
  CHECK(refused.err.find("half_offset = true") != std::string::npos);

  run.sets.emplace_back("driver.half_offset=true");
  CHECK(try_run(run).exit_code == 0);
}

TEST_CASE("both corrections of cibc damp with their signs, and each one turned round makes the run blow up")
{
  // The times come from a separate tool: 1.60 with the velocity's sign turned, 0.31 with the traction's, 0.195 both.
  CHECK(time_of_blow_up(1.0, 1.0) >= 5.0);
  const double velocity = time_of_blow_up(-1.0, 1.0), traction = time_of_blow_up(1.0, -1.0);
  const double both = time_of_blow_up(-1.0, -1.0);
  CHECK(velocity > 1.2);
  CHECK(velocity < 2.0);
  CHECK(traction < 0.4);
  CHECK(both < 0.25);
}

TEST_CASE("the cibc of a case file has the signs that damp")
{
  const PistonRun run{.piston = strong_feedback,
                      .cells = feedback_cells,
                      .dt = courant_step(strong_feedback, feedback_cells, 0.3),
                      .end = 5.0,
                      .sets = {"driver.scheme=cibc", "driver.fluid_density=1.3", "driver.omega_check=warn",
                               fmt::format("driver.omega={}", feedback_kappa / strong_feedback.fluid_speed())}};

  // A mode of amplitude 1e-6: 1 % for what the discrete mode's shape differs from the exact one's.
  CHECK(largest_displacement(history_of(run)) <= 1.01 * mode_amplitude);
}
