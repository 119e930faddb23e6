// The exact piston solutions against numbers that two independent prototypes gave, and against each
// other.
#include "support/exact_piston.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace mullion::testing;

TEST_CASE("the piston's scales follow from its ratios")
{
  const Piston piston;

  CHECK(piston.fluid_speed() == doctest::Approx(328.16506).epsilon(1e-7)); // sqrt(1.4e5 / 1.3)
  CHECK(piston.fluid_frequency() == doctest::Approx(164.0825).epsilon(1e-6));
  CHECK(piston.fluid_impedance() == doctest::Approx(426.6146).epsilon(1e-6));
  CHECK(piston.solid_impedance() == doctest::Approx(200.0 * 426.6146).epsilon(1e-6));
  CHECK(piston.youngs_modulus() == doctest::Approx(2.8e6).epsilon(1e-12));
  CHECK(piston.solid_length() == doctest::Approx(0.2).epsilon(1e-14));
}

TEST_CASE("closed modes agree with the tabulated frequencies, amplitudes and growth rates per lag")
{
  // From a separate Python tool (root finding on the frequency equation; 10 digits as printed):
  // frequency over f_f, amplitude over static displacement, static displacement for dp = 1e5 Pa,
  // growth per unit of f_f t for a lag of one step at C_f = 0.1 on 100 cells.
  struct Row {
    int numerator, denominator;
    double mu;
    int mode;
    double frequency, amplitude, static_displacement, growth;
  };
  const std::vector<Row> table{
      {4, 25, 2000, 1, 0.0809791518, -8.05337703e-01, 2.16450216e-02, 1.545243e-06},
      {4, 25, 2000, 4, 0.5599514636, -1.70479870e-02, 2.16450216e-02, -5.360284e-07},
      {1, 2, 2000, 1, 0.2507918189, -8.09466426e-01, 7.07213579e-03, 3.900376e-06},
      {1, 2, 2000, 2, 0.7492081811, -9.07027697e-02, 7.07213579e-03, -1.165187e-05},
      {1, 2, 100, 1, 0.2644886349, -7.90032195e-01, 1.19047619e-01, 6.895624e-05},
      {1, 2, 20, 1, 0.3040867240, -7.30489665e-01, 3.57142857e-01, 2.251703e-04},
      {1, 2, 20, 8, 3.6959132760, -4.94499039e-03, 3.57142857e-01, -2.736752e-03},
      {97, 100, 2000, 1, 0.4850724517, -8.10564354e-01, 3.66300366e-03, 6.903657e-07},
      {97, 50, 2000, 1, 0.9503660769, -6.03320237e-01, 1.83621006e-03, -2.625743e-04},
      {97, 50, 2000, 2, 1.0197050283, -2.07677625e-01, 1.83621006e-03, 2.831595e-04},
  };
  for (const Row& row : table) {
    CAPTURE(row.numerator);
    CAPTURE(row.mu);
    CAPTURE(row.mode);
    Piston piston;
    piston.frequency_numerator = row.numerator;
    piston.frequency_denominator = row.denominator;
    piston.density_ratio = row.mu;
    const double ff = piston.fluid_frequency();

    const double w = closed_frequencies(piston, row.mode).back();
    const double tau = 0.1 * 0.01 / piston.fluid_speed();

    CHECK(std::abs(w / (2.0 * std::numbers::pi * ff) - row.frequency) <
          1e-10); // last printed digit
    CHECK(piston.static_displacement() == doctest::Approx(row.static_displacement).epsilon(1e-8));
    CHECK(lag_growth_rate(piston, w, tau) / ff == doctest::Approx(row.growth).epsilon(1e-6));
    CHECK(closed_amplitude(piston, w) / piston.static_displacement() ==
          doctest::Approx(row.amplitude).epsilon(1e-8));
  }
}

TEST_CASE(
    "the closed piston answers the load step with the displacements that are known for f_r = 0.5")
{
  const Piston piston;
  const double ff = piston.fluid_frequency();
  const auto frequencies =
      closed_frequencies(piston, 20000); // tail of the sum below 0.81 u_static / 20000 / 2
  const CharacteristicsSolution waves(piston, TubeEnd::closed, 401.0 / ff);
  struct Point {
    double time, displacement;
  };
  for (const auto& [time, displacement] : {Point{0.37, 0.00262971}, Point{3.21, 0.0055039},
                                           Point{77.7, 0.01244757}, Point{400.3, 0.01102098}}) {
    CHECK(std::abs(closed_displacement(piston, frequencies, time / ff) - displacement) < 1e-7);
    CHECK(std::abs(waves.at(time / ff).displacement - displacement) <
          1e-7); // of 8 printed decimals
  }
}

TEST_CASE("modal sum and characteristics are the same solution")
{
  for (const int numerator : {16, 32, 97}) { // over 100, in lowest terms or not
    Piston piston;
    piston.frequency_numerator = numerator;
    piston.frequency_denominator = 100;
    piston.density_ratio = 50;
    const double ff = piston.fluid_frequency();
    const auto frequencies = closed_frequencies(piston, 10000);
    const CharacteristicsSolution waves(piston, TubeEnd::closed, 31.0 / ff);

    for (int i = 0; i < 60; ++i) {
      const double t = (0.013 + 0.5 * i) / ff;
      const double modal = closed_displacement(piston, frequencies, t);
      // tail of the modal sum: terms of A_k ~ 1/k^2 with oscillating signs, 10,000 of them taken
      CHECK(std::abs(modal - waves.at(t).displacement) < 2e-5 * piston.static_displacement());
    }
  }
}

TEST_CASE("the amplitudes of all closed modes cancel the static displacement at the start")
{
  const Piston piston;

  const auto frequencies = closed_frequencies(piston, 20000);

  // u_I(0) = 0; the tail of 1/k^2 left out is 4/pi^2 / 20000 = 2e-5
  CHECK(std::abs(closed_displacement(piston, frequencies, 0.0)) <
        4e-5 * piston.static_displacement());
}

TEST_CASE(
    "the open piston is a square wave that decays by (z_s - z_f) / (z_s + z_f) each bar period")
{
  const Piston piston; // f_r = 0.5: T_s = 2 / f_f
  const double ff = piston.fluid_frequency();
  const double z_f = piston.fluid_impedance();
  const double z_s = piston.solid_impedance();
  const double ratio = (z_s - z_f) / (z_s + z_f);
  const CharacteristicsSolution waves(piston, TubeEnd::open, 50.0 / ff);

  for (int n = 0; n < 20; ++n) {
    const InterfaceState state = waves.at((2.0 * n + 0.7) / ff);
    const double exact = 1e5 / (z_s + z_f) * std::pow(-ratio, n);
    CHECK(state.velocity == doctest::Approx(exact).epsilon(1e-13));
    CHECK(state.pressure == doctest::Approx(-z_f * exact).epsilon(1e-13));
  }
  CHECK(open_decay_rate(piston) == doctest::Approx(-0.00500004).epsilon(1e-6));
  CHECK(open_decay_rate(piston) == doctest::Approx(0.5 * std::log(ratio)).epsilon(1e-12));
}

TEST_CASE("before any wave is back the interface moves as between two half-spaces")
{
  const Piston piston;
  const CharacteristicsSolution waves(piston, TubeEnd::closed, 1.0);

  const InterfaceState state = waves.at(0.5 / piston.fluid_frequency());

  const double v = 1e5 / (piston.solid_impedance() + piston.fluid_impedance());
  CHECK(state.velocity == doctest::Approx(v).epsilon(1e-14));
  CHECK(state.displacement == doctest::Approx(v * 0.5 / piston.fluid_frequency()).epsilon(1e-14));
}
