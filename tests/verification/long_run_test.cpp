// What hundreds of periods do to the piston: the energy that a scheme makes or loses at the interface, how large the
// pressure's swing becomes in a case with strong feedback, the decay that an open end must cause, and whether mesh and
// structure stay together. Jaiman et al. 2011, section 6, says what each scheme is good for; the numbers that it must
// meet come from two separate tools (a nonlinear one and the eigenvalues of the linearised schemes).
#include "support/piston_run.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace mullion::test;
using mullion::testing::Piston;
using mullion::testing::worst;

namespace {

using Sets = std::vector<std::string>;

const Sets css_l = {"driver.scheme=css", "driver.profile=linear"};
const Sets gss_mean_l = {"driver.scheme=gss", "driver.beta=0.5"};
const Sets gss = {"driver.scheme=gss"};
const Sets iss = {"driver.scheme=iss"};
const Sets explicit_lagfree = {"driver.scheme=explicit_lagfree", "structure.integrator=central_difference"};
const Sets strong = {"driver.scheme=strong", "driver.motion_tolerance=1e-9", "driver.traction_tolerance=1e-9"};

/// The weight kappa = omega c; a warning, not an error, where the moving gas comes near a bound for a moment.
Sets cibc(const Piston& piston, double kappa)
{
  return {"driver.scheme=cibc", fmt::format("driver.fluid_density={}", piston.rho0),
          fmt::format("driver.omega={}", kappa / piston.fluid_speed()), "driver.omega_check=warn"};
}

Piston with_frequency_ratio(double density_ratio, int numerator, int denominator, double dp)
{
  return {
      .density_ratio = density_ratio, .frequency_numerator = numerator, .frequency_denominator = denominator, .dp = dp};
}

/// Largest change of the total energy over the largest energy of the bar. p_ref = 0: the surroundings do no work.
double energy_drift(const Piston& piston, double end, const Sets& sets)
{
  const auto history = history_of({.piston = piston,
                                   .cells = 50,
                                   .dt = courant_step(piston, 50, 0.1),
                                   .end = end,
                                   .start = Start::load_step,
                                   .sets = sets});
  const auto& gas = history.at("fluid.volume.total_energy");
  const auto& bar = history.at("structure.body.energy");
  double largest = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    largest = worst(largest, std::abs((gas[i] - gas[0]) + (bar[i] - bar[0])));
    scale = std::max(scale, bar[i]);
  }
  return largest / scale;
}

/// Last over first deviation of the wall's pressure in windows of f_f t = 20; mu = 100, f_r = 0.97, to f_f t = 300.
double swing_ratio(const Sets& sets)
{
  const auto piston = with_frequency_ratio(100.0, 97, 100, 100.0);
  const auto history = history_of({.piston = piston,
                                   .cells = 40,
                                   .dt = courant_step(piston, 40, 0.3),
                                   .end = 300.0,
                                   .start = Start::load_step,
                                   .sets = sets});
  const auto deviation = windowed_deviation(history, "fluid.wall.traction", piston, 20.0);
  REQUIRE(deviation.size() == 15);
  return deviation.back() / deviation.front();
}

/// Slope of ln(deviation of v_I in windows of f_f t = 4), open left end.
double open_decay(double courant, double end, const Sets& sets)
{
  const Piston piston;
  auto run = PistonRun{.piston = piston,
                       .cells = 40,
                       .dt = courant_step(piston, 40, courant),
                       .end = end,
                       .start = Start::load_step,
                       .sets = sets};
  run.sets.push_back("fluid.left_end=open");
  const auto deviation = windowed_deviation(history_of(run), "structure.wet.velocity", piston, 4.0);
  double n = 0, sum_t = 0, sum_y = 0, sum_tt = 0, sum_ty = 0;
  for (std::size_t i = 0; i < deviation.size(); ++i) {
    const double t = 4.0 * static_cast<double>(i), y = std::log(deviation[i]);
    n += 1, sum_t += t, sum_y += y, sum_tt += t * t, sum_ty += t * y;
  }
  const double slope = (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
  return slope;
}

/// Largest distance between the gas's mesh and the bar's end [m]. The mesh stretches evenly, so the wall lies at the
/// length of its last cell times their number.
double mesh_drift(const Piston& piston, double courant, double end, const Sets& sets)
{
  const PistonRun run{.piston = piston,
                      .cells = 40,
                      .dt = courant_step(piston, 40, courant),
                      .end = end,
                      .start = Start::load_step,
                      .sets = sets};
  const auto history = history_of(run);
  const auto& spacing = history.at("fluid.wall.wall_spacing");
  const auto& u = history.at("structure.wet.displacement");
  double largest = 0.0;
  for (std::size_t i = 0; i < u.size(); ++i)
    largest = worst(largest, std::abs(spacing[i] * run.cells - piston.fluid_length - u[i]));
  return largest;
}

} // namespace

TEST_CASE("schemes without net lag keep the energy, CSS makes some, averaged loads about half as much")
{
  const Piston piston; // mu = 2000, f_r = 0.5, the step is the whole pressure
  const double lagging = energy_drift(piston, 25.0, css_l);

  // Over a quarter of the time of the full tier, hence a quarter of its drift at least; the bounded ones stay.
  CHECK(lagging >= 0.25e-4);
  const double ratio = energy_drift(piston, 25.0, gss_mean_l) / lagging;
  CHECK(ratio >= 0.4);
  CHECK(ratio <= 0.6);
  for (const auto& sets : {explicit_lagfree, gss, strong}) CHECK(energy_drift(piston, 25.0, sets) <= 1e-5);
}

TEST_CASE(
    "where gas and bar feed one another CSS grows twelvefold, GSS as Algorithm 2 half as fast, lag-free ones decay")
{
  // Gas scheme and mesh let the pressure's swing decay to about 0.48 by themselves.
  CHECK(swing_ratio(css_l) > 8.0);
  const double averaged = swing_ratio(gss_mean_l);
  CHECK(averaged >= 1.5);
  CHECK(averaged <= 2.3);
  const double second_order = swing_ratio(gss);
  CHECK(second_order >= 0.45);
  CHECK(second_order <= 0.52);
  const double corrected = swing_ratio(cibc(Piston{}, 0.45));
  CHECK(corrected >= 0.30);
  CHECK(corrected <= 0.40);
}

TEST_CASE("the mesh follows the structure, exactly where it gets its velocity, within a bound under CIBC")
{
  const Piston piston;
  // Round-off of positions of 1 m over 8000 steps; a velocity of another level would be off by v dt = 1e-5.
  for (const auto& sets : {css_l, explicit_lagfree, strong}) CHECK(mesh_drift(piston, 0.5, 50.0, sets) <= 1e-12);
  const double drift = mesh_drift(piston, 0.1, 25.0, cibc(piston, 0.4));
  CHECK(drift <= 5e-5);  // measured with a separate tool: 2e-5
  CHECK(drift >= 1e-12); // it is another velocity, after all
}

TEST_SUITE("full")
{
  TEST_CASE("the energy over a hundred periods of the gas, three frequency ratios")
  {
    for (const auto& [numerator, denominator] : {std::pair(1, 2), std::pair(97, 100), std::pair(4, 25)}) {
      const auto piston = with_frequency_ratio(2000.0, numerator, denominator, 1e5);
      const double lagging = energy_drift(piston, 100.0, css_l);

      CHECK(lagging >= 1e-4);
      const double ratio = energy_drift(piston, 100.0, gss_mean_l) / lagging;
      CHECK(ratio >= 0.4);
      CHECK(ratio <= 0.6);
      for (const auto& sets : {explicit_lagfree, gss, strong}) CHECK(energy_drift(piston, 100.0, sets) <= 1e-5);
    }
  }

  TEST_CASE("where gas and bar feed one another, every scheme without a lag decays as strong coupling does")
  {
    for (const auto& sets : {strong, explicit_lagfree, iss, gss}) {
      const double ratio = swing_ratio(sets);
      CHECK(ratio >= 0.45);
      CHECK(ratio <= 0.52);
    }
  }

  TEST_CASE("the open end lets the swing decay at the exact rate, whatever the scheme")
  {
    // A load that resists the motion is not fed by a lag at first order. 0.5 %: two separate tools gave +0.04 % for
    // these, +0.09 % for CIBC.
    const double exact = open_decay_rate(Piston{});
    CHECK(exact == doctest::Approx(-0.0050000).epsilon(1e-5));
    for (const auto& sets : {css_l, gss, strong, iss})
      CHECK(open_decay(0.25, 300.0, sets) == doctest::Approx(exact).epsilon(5e-3));
    CHECK(open_decay(0.25, 300.0, cibc(Piston{}, 0.4)) == doctest::Approx(exact).epsilon(5e-3));
  }

  TEST_CASE("the mesh over 500 periods of the gas")
  {
    for (const auto& sets : {css_l, explicit_lagfree, strong}) CHECK(mesh_drift(Piston{}, 0.5, 500.0, sets) <= 1e-12);
    const auto drift = [](int numerator, int denominator) {
      const auto piston = with_frequency_ratio(2000.0, numerator, denominator, 1e5);
      return mesh_drift(piston, 0.1, 500.0, cibc(piston, 0.4));
    };
    CHECK(drift(1, 2) <= 5e-5);
    CHECK(drift(97, 100) <= 5e-5);
    CHECK(drift(97, 50) <= 2e-4);
  }
}
