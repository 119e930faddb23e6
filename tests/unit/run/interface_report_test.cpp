// What the summary says of the interface, on synthetic signals, and the growth that a lag makes against the piston.
#include "run/interface_report.hpp"

#include "support/exact_piston.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace mullion::run;
using mullion::testing::Piston;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

/// A growing oscillation along y, and the structure's energy E that goes with it. The interface made `share` of what
/// the structure gained: the defect is -share (E - E_0).
struct Oscillation {
  double frequency = 50.0, growth = 0.1, share = 1.0;
  double dt = 1e-4, duration = 1.0;

  [[nodiscard]] InterfaceSeries series() const
  {
    InterfaceSeries series;
    const auto n = static_cast<int>(std::lround(duration / dt));
    for (int i = 0; i <= n; ++i) {
      const double t = i * dt, energy = 3.0 * std::exp(2.0 * growth * t);
      InterfaceSeries::Sample sample;
      sample.time = t;
      sample.velocity[0] = 100.0 + 1e-4 * std::sin(two_pi * 7.0 * t); // a large mean is no motion
      sample.velocity[1] = 0.02 * std::exp(growth * t) * std::cos(two_pi * frequency * t);
      sample.structure_energy = energy;
      sample.defect = -share * (energy - 3.0);
      series.add(sample);
    }
    return series;
  }
};

} // namespace

TEST_CASE("the interface's series never grows beyond its capacity, and keeps samples at equal distances")
{
  InterfaceSeries series;
  constexpr int n = 5 * static_cast<int>(InterfaceSeries::capacity);
  int stride = 1;
  for (int i = 0; i <= n; ++i) {
    InterfaceSeries::Sample sample;
    sample.time = i;
    series.add(sample);

    REQUIRE(series.samples().size() < InterfaceSeries::capacity);
    REQUIRE(series.stride() >= stride);
    stride = series.stride();
    REQUIRE(i - series.samples().back().time < 2 * stride); // the newest may have gone in a thinning
  }

  CHECK(stride == 8); // 5 capacities: thinned out at 1, 2 and 4 of them
  for (std::size_t k = 0; k < series.samples().size(); ++k)
    REQUIRE(series.samples()[k].time == static_cast<double>(k) * stride);
}

TEST_CASE("the motion is fitted to the component that moves most, whatever the means")
{
  const auto series = Oscillation{}.series();

  const auto motion = fit_motion(series.samples());

  // The model holds to round-off; the fit stops at about the square root of it in the residual.
  CHECK(motion.frequency == doctest::Approx(50.0).epsilon(1e-7));
  CHECK(motion.growth == doctest::Approx(0.1).epsilon(1e-5));
  CHECK(motion.relative_residual < 1e-6);
}

TEST_CASE("where nothing oscillates there is no frequency")
{
  InterfaceSeries series;
  for (int i = 0; i < 1000; ++i) {
    InterfaceSeries::Sample sample;
    sample.time = 1e-3 * i;
    sample.velocity[0] = 2.5;
    series.add(sample);
  }

  CHECK(fit_motion(series.samples()).frequency == 0.0);
  CHECK(fit_motion(series.samples().first(5)).frequency == 0.0);
  CHECK_FALSE(find_manufactured_energy(series).has_value());
}

TEST_CASE("growth that the defect explains is manufactured energy, and both rates are told")
{
  const auto made = find_manufactured_energy(Oscillation{}.series());

  REQUIRE(made.has_value());
  CHECK(made->frequency == doctest::Approx(50.0).epsilon(1e-6));
  CHECK(made->growth == doctest::Approx(0.1).epsilon(1e-4));
  // A line through an exponential, over its mean: off by (2 sigma T)^2 / 60 or so, with 2 sigma T = 0.08
  CHECK(made->explained == doctest::Approx(0.1).epsilon(1e-3));
}

TEST_CASE("the defect explains growth up to a factor of two, and only with the right sign")
{
  for (const double share : {0.6, 1.9})
    CHECK(find_manufactured_energy(Oscillation{.share = share}.series()).has_value());
  for (const double share : {0.4, 2.1, 0.0, -1.0})
    CHECK_FALSE(find_manufactured_energy(Oscillation{.share = share}.series()).has_value());
}

TEST_CASE("growth below 2 % over 20 periods is none, and decay is none")
{
  // 20 periods are 0.4 s: 2 % are sigma = 0.0495
  CHECK(find_manufactured_energy(Oscillation{.growth = 0.055}.series()).has_value());
  CHECK_FALSE(find_manufactured_energy(Oscillation{.growth = 0.045}.series()).has_value());
  CHECK_FALSE(find_manufactured_energy(Oscillation{.growth = -0.1}.series()).has_value());
}

TEST_CASE("fewer than 20 periods, or than 200 steps, are too few to blame anyone")
{
  CHECK(find_manufactured_energy(Oscillation{.duration = 0.41}.series()).has_value());
  CHECK_FALSE(find_manufactured_energy(Oscillation{.duration = 0.38}.series()).has_value());
  // 8 steps a period: 20 periods are 160 steps
  CHECK(find_manufactured_energy(Oscillation{.dt = 2.5e-3, .duration = 0.55}.series()).has_value());
  CHECK_FALSE(find_manufactured_energy(Oscillation{.dt = 2.5e-3, .duration = 0.45}.series()).has_value());
}

TEST_CASE("a thinned series gives the same answer")
{
  // 100,000 steps: every other one is kept
  const auto series = Oscillation{.growth = 0.01, .dt = 1e-4, .duration = 10.0}.series();
  REQUIRE(series.stride() == 2);

  CHECK_FALSE(find_manufactured_energy(series).has_value()); // 0.4 % over 20 periods
  CHECK(fit_motion(series.samples()).growth == doctest::Approx(0.01).epsilon(1e-4));
}

TEST_CASE("the growth that a lag makes agrees with the piston's, to first order in the gas's share")
{
  // The estimate counts the bar's inertia only. By the frequency equation, with z_s cot(w L_s/c_s) = -z_f cot(w
  // L_f/c_f) at the mode and cot x = pi/2 - x + O((pi/2 - x)^3) at the bar's own frequency, its ratio to the exact rate
  // is
  //
  //     1 + z_f (L_f/c_f) / sin^2(w L_f/c_f) / (z_s L_s/c_s) + O(1/mu^2),   w L_f/c_f = pi f_r / 2
  //
  // with the piston's numbers, f_r = 1/2 and L_s = 0.2 L_f: 1 + 10 / mu.
  for (const double mu : {2e3, 2e4, 2e5}) {
    Piston piston;
    piston.density_ratio = mu;
    const double omega = closed_frequencies(piston, 1)[0], lag = 1e-6;
    const double vacuum = piston.solid_speed() / (4.0 * piston.solid_length()); // a quarter wave in the bar

    const double ratio = growth_from_lag(lag, omega / two_pi, vacuum) / lag_growth_rate(piston, omega, lag);

    CHECK(std::abs((ratio - 1.0) * mu / 10.0 - 1.0) < 100.0 / mu);
  }
}

TEST_CASE("a lag damps where the fluid lowers the frequency, and without lag nothing grows")
{
  CHECK(growth_from_lag(1e-6, 40.0, 39.0) > 0.0);
  CHECK(growth_from_lag(1e-6, 39.0, 40.0) < 0.0);
  CHECK(growth_from_lag(-1e-6, 40.0, 39.0) < 0.0);
  CHECK(growth_from_lag(0.0, 40.0, 39.0) == 0.0);
}
