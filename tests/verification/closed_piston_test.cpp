// The closed piston run by `mullion run` from its case file: against the exact linear solution, against the lag law, and
// to the bit against hand-written loops over the same kernels.
#include "support/coupled_piston.hpp"
#include "support/history.hpp"
#include "support/run_case.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::test;
using mullion::testing::CoupledPiston;
using mullion::testing::Piston;
using mullion::testing::Profile;
using mullion::testing::worst;

namespace {

const std::string closed_piston = MULLION_SOURCE_DIR "/configs/closed_piston.toml";

/// A run that starts in the first mode of the coupled problem, inline, without result files.
History run_mode(const Piston& piston, int cells, double dt, int steps, const std::vector<std::string>& driver)
{
  const double omega = closed_frequencies(piston, 1)[0];
  CaseRun run;
  run.file = closed_piston;
  run.flags = {"--inline"};
  const auto set = [&](const std::string& key, const auto& value) { run.sets.push_back(fmt::format("{}={}", key, value)); };
  set("run.dt", dt);
  set("run.end_time", steps * dt);
  set("fluid.cells", cells);
  set("structure.density", piston.solid_density());
  set("structure.youngs_modulus", piston.youngs_modulus());
  set("structure.length", piston.solid_length());
  set("structure.elements", std::max(1L, std::lround(piston.solid_length() * cells)));
  for (const std::string module : {"fluid", "structure"}) {
    set(module + ".initial", "mode");
    set(module + ".mode_amplitude", CoupledPiston::amplitude);
    set(module + ".mode_angular_frequency", omega);
  }
  set("coupling.reference_pressure", piston.p0); // the load step is zero
  set("output.every", 0);
  set("expect", "[]");
  for (const auto& option : driver) run.sets.push_back("driver." + option);

  const RunFolder folder;
  const auto result = folder.run(run);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  return read_history(folder / "out/history.csv");
}

/// Slope of the least-squares line through ln sqrt(u^2 + (v / w)^2) over f_f t.
double growth_rate(const History& history, const Piston& piston)
{
  const double omega = closed_frequencies(piston, 1)[0];
  const auto& u = history.at("structure.wet.displacement");
  const auto& v = history.at("structure.wet.velocity");
  double n = 0, sum_t = 0, sum_y = 0, sum_tt = 0, sum_ty = 0;
  for (std::size_t i = 1; i < u.size(); ++i) {
    const double t = history.at("time")[i] * piston.fluid_frequency();
    const double y = std::log(std::hypot(u[i], v[i] / omega) / CoupledPiston::amplitude);
    n += 1, sum_t += t, sum_y += y, sum_tt += t * t, sum_ty += t * y;
  }
  return (n * sum_ty - sum_t * sum_y) / (n * sum_tt - sum_t * sum_t);
}

double css_growth(double duration, const std::vector<std::string>& driver)
{
  const Piston piston{.density_ratio = 200.0};
  const double dt = 0.5 * 0.02 / piston.fluid_speed(); // C_f = 0.5
  const int steps = static_cast<int>(std::lround(duration / (dt * piston.fluid_frequency())));
  return growth_rate(run_mode(piston, 50, dt, steps, driver), piston);
}

} // namespace

TEST_CASE("a run gives the bits of a hand-written loop over the same kernels")
{
  const Piston piston{.density_ratio = 20.0};
  const double dt = 0.5 * 0.05 / piston.fluid_speed();
  const int steps = 400;
  struct Variant {
    const char *order, *profile;
  };
  for (const auto& [order, profile] : {Variant{"structure_first", "constant"}, Variant{"structure_first", "linear"},
                                       Variant{"fluid_first", "constant"}, Variant{"fluid_first", "linear"}}) {
    CAPTURE(order);
    CAPTURE(profile);
    CoupledPiston loop(piston, 20, dt);

    const auto run = run_mode(piston, 20, dt, steps, {fmt::format("order={}", order), fmt::format("profile={}", profile)});

    const auto& u = run.at("structure.wet.displacement");
    const auto kind = std::string(profile) == "constant" ? Profile::constant : Profile::linear;
    REQUIRE(u.size() == steps + 1);
    int n_different = 0;
    for (int n = 1; n <= steps; ++n) {
      if (std::string(order) == "structure_first") loop.css_structure_first(kind);
      else loop.css_fluid_first(kind);
      n_different += u[static_cast<std::size_t>(n)] != loop.u();
    }
    CHECK(n_different == 0);
  }
}

TEST_CASE("the oscillation after the load step has the exact amplitude and frequency, and case and theory agree on both")
{
  const Piston piston; // mu = 2000, f_r = 0.5, the step is the whole pressure
  const double first = closed_frequencies(piston, 1)[0] / (2.0 * std::numbers::pi);
  const auto exact = [&] {
    const auto omegas = closed_frequencies(piston, 400);
    double low = 0.0, high = 0.0;
    for (int i = 0; i <= 4000; ++i) {
      const double u = closed_displacement(piston, omegas, 0.01 * i / piston.fluid_frequency());
      low = std::min(low, u), high = std::max(high, u);
    }
    return (high - low) / 2.0;
  }();
  const RunFolder folder;

  const auto result = folder.run({.file = closed_piston, .flags = {"--inline"}});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  const auto measured = [&](const std::string& what) { // "  amplitude  0.00701 (expected 0.00707, -0.8 %)"
    const auto line = result.out.find("  " + what);
    REQUIRE(line != std::string::npos);
    return std::pair(std::stod(result.out.substr(line + 2 + what.size())),
                     std::stod(result.out.substr(result.out.find("expected ", line) + 9)));
  };
  const auto [amplitude, expected_amplitude] = measured("amplitude");
  const auto [frequency, expected_frequency] = measured("frequency");
  // What the case file expects is the theory, to its printed digits and the sampling of the maximum.
  CHECK(expected_frequency == doctest::Approx(first).epsilon(1.3e-6)); // six printed digits
  CHECK(expected_amplitude == doctest::Approx(exact).epsilon(1e-4));
  // Linear elements with lumped mass, dx = L_s / 80: the first mode is slow by (k dx)^2 / 24 = 1.6e-5; Newmark adds
  // (w dt)^2 / 12 = 2e-7; the spectrum of 10 periods leaks 1e-4.
  CHECK(frequency == doctest::Approx(first).epsilon(1.2e-4));
  // The extremes are corners of the exact solution, which a mesh rounds off over a few elements: 1 % at 80.
  CHECK(amplitude == doctest::Approx(exact).epsilon(0.01));
}

TEST_CASE("CSS grows as the lag law says, for every alpha, beta, order and profile")
{
  const Piston piston{.density_ratio = 200.0};
  const double dt = 0.5 * 0.02 / piston.fluid_speed();
  const double per_step =
      lag_growth_rate(piston, closed_frequencies(piston, 1)[0], dt) / piston.fluid_frequency();
  const auto expect_lag = [&](double lag, const std::vector<std::string>& driver) {
    CAPTURE(lag);
    // 3 % of one step's growth: an error of 0.03 steps in the lag
    CHECK(std::abs(css_growth(100.0, driver) - lag * per_step) < 0.03 * per_step);
  };

  expect_lag(0.5, {"profile=constant"});
  expect_lag(1.0, {"profile=linear"});
  expect_lag(1.0, {"profile=constant", "alpha=0.5"});
  expect_lag(0.75, {"profile=constant", "beta=0.25"});
  expect_lag(1.75, {"profile=linear", "alpha=0.5", "beta=0.25"});
  expect_lag(0.5, {"profile=constant", "order=fluid_first"});
  expect_lag(1.5, {"profile=linear", "order=fluid_first", "beta=0.5"});
}

TEST_CASE("a run of CSS is second order in space at a fixed step")
{
  const Piston piston{.density_ratio = 20.0};
  const double dt = 0.05 / 80 / piston.fluid_speed(); // Courant number 0.05 on 80 cells
  const int steps = static_cast<int>(4.0 / piston.fluid_frequency() / dt);
  const auto u = [&](int cells) { return run_mode(piston, cells, dt, steps, {}).at("structure.wet.displacement"); };
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = worst(largest, std::abs(a[i] - b[i]));
    return largest / CoupledPiston::amplitude;
  };
  const auto u40 = u(40), u80 = u(80), u160 = u(160);

  const double coarse = distance(u40, u80), fine = distance(u80, u160);

  CHECK(coarse == doctest::Approx(4.83e-3).epsilon(0.02)); // two independent prototypes; 2 % for details
  CHECK(fine == doctest::Approx(1.22e-3).epsilon(0.02));
  CHECK(std::log2(coarse / fine) >= 1.9);
}

TEST_CASE("a run of CSS is first order in time")
{
  const Piston piston{.density_ratio = 20.0};
  const double sample = 0.04 / piston.fluid_frequency();
  CoupledPiston reference(piston, 40, sample / 512); // strong coupling, Courant number 0.00625
  std::vector<double> exact;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 512; ++k) reference.strong();
    exact.push_back(reference.u());
  }
  const auto error = [&](int steps_per_sample, const char* profile) {
    const auto run = run_mode(piston, 40, sample / steps_per_sample, 100 * steps_per_sample,
                              {fmt::format("profile={}", profile)});
    double largest = 0.0;
    for (int i = 0; i < 100; ++i)
      largest = worst(largest, std::abs(run.at("structure.wet.displacement")[static_cast<std::size_t>((i + 1) * steps_per_sample)] -
                                        exact[static_cast<std::size_t>(i)]));
    return largest / CoupledPiston::amplitude;
  };
  for (const char* profile : {"constant", "linear"}) {
    const double coarse = error(16, profile), fine = error(32, profile); // Courant numbers 0.2 and 0.1

    CHECK(std::log2(coarse / fine) > 0.9);
    CHECK(std::log2(coarse / fine) < 1.1);
    CHECK(fine < 4e-3); // the phase error of half a step to one step of lag
  }
}

TEST_SUITE("full")
{
  TEST_CASE("growth rates over f_f t = 400 agree with the eigenvalues of the coupled schemes")
  {
    // Eigenvalues of the linearised one-step matrices, from a separate tool.
    CHECK(css_growth(400.0, {"profile=constant"}) == doctest::Approx(1.838e-4).epsilon(0.03));
    CHECK(css_growth(400.0, {"profile=linear"}) == doctest::Approx(3.668e-4).epsilon(0.03));
  }
}
