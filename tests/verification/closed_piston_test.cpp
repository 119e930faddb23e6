// The closed piston run by `mullion run` from its case file: against the exact linear solution, and its order in space.
#include "support/exact_piston.hpp"
#include "support/piston_run.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion::test;
using mullion::testing::Piston;
using mullion::testing::worst;

TEST_CASE(
    "the oscillation after the load step has the exact amplitude and frequency, and case and theory agree on both")
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

  const auto result = folder.run({.file = MULLION_SOURCE_DIR "/configs/closed_piston.toml", .flags = {"--inline"}});

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

TEST_CASE("a run of CSS is second order in space at a fixed step")
{
  const Piston piston{.density_ratio = 20.0};
  const double dt = 0.05 / 80 / piston.fluid_speed(); // Courant number 0.05 on 80 cells
  const auto u = [&](int cells) {
    return history_of({.piston = piston, .cells = cells, .dt = dt, .end = 4.0}).at("structure.wet.displacement");
  };
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = worst(largest, std::abs(a[i] - b[i]));
    return largest / mode_amplitude;
  };
  const auto u40 = u(40), u80 = u(80), u160 = u(160);

  const double coarse = distance(u40, u80), fine = distance(u80, u160);

  CHECK(coarse == doctest::Approx(4.83e-3).epsilon(0.02)); // two independent prototypes; 2 % for details
  CHECK(fine == doctest::Approx(1.22e-3).epsilon(0.02));
  CHECK(std::log2(coarse / fine) >= 1.9);
}
