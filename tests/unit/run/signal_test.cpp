// Amplitude, frequency and growth of signals whose formula is known.
#include "run/signal.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <ctime>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace mullion;
using namespace mullion::run;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

struct Signal {
  Signal(std::size_t n, double dt, const std::function<double(double)>& formula, double begin = 0.0)
      : times(n), values(n)
  {
    for (std::size_t i = 0; i < n; ++i) {
      times[i] = begin + static_cast<double>(i) * dt;
      values[i] = formula(times[i]);
    }
  }
  std::vector<double> times, values;
};

double relative_error(double found, double expected) { return std::abs(found - expected) / std::abs(expected); }

} // namespace

TEST_CASE("the amplitude is half of the range")
{
  CHECK(amplitude(std::vector{1.0, -3.0, 2.0}) == 2.5);
  CHECK(amplitude(std::vector{7.0}) == 0.0);
  CHECK(amplitude({}) == 0.0);
}

TEST_CASE("the frequency of a sine is found between the lines of the spectrum, whatever its phase, "
          "mean and drift")
{
  for (const double frequency : {20.3, 41.7, 123.456, 480.1})
    for (const double phase : {0.0, 0.7, 2.0}) {
      const Signal signal(2000, 1e-3,
                          [&](double t) { return 1e3 + 5.0 * t + 0.01 * std::sin(two_pi * frequency * t + phase); });

      // 40 periods or more, or half the sampling rate less 40 lines: leakage ~ 1 / (80^3 40) = 5e-8, ten times that
      CHECK(relative_error(dominant_frequency(signal.times, signal.values), frequency) < 5e-7);
    }
}

TEST_CASE("the leakage at few periods is what the documentation says")
{
  double largest_3 = 0.0, largest_10 = 0.0;
  for (double phase = 0.0; phase < 6.3; phase += 0.1) {
    const auto error = [&](double periods) {
      const Signal signal(1000, 1e-3, [&](double t) { return std::sin(two_pi * periods * t + phase); });
      return relative_error(dominant_frequency(signal.times, signal.values), periods);
    };
    largest_3 = std::max(largest_3, error(3.2));
    largest_10 = std::max(largest_10, error(10.2));
  }

  CHECK(largest_3 < 4e-3);
  CHECK(largest_10 < 1e-5);
}

TEST_CASE("the tops of a spectrum are its oscillations, not the window's side lobes")
{
  // 12.3 and 31.7 periods in the record, the second with 1 % of the amplitude; side lobes of the first reach 2.7 % at
  // 2.4 periods from it and are below 3e-7 at 19: what moves the second top is leakage of that size over its own.
  const Signal two(2000, 5e-4, [](double t) {
    return std::cos(two_pi * 12.3 * t + 0.4) + 0.01 * std::cos(two_pi * 31.7 * t) + 3.0 - 2.0 * t;
  });

  const auto peaks = spectral_peaks(two.times, two.values, 2);

  REQUIRE(peaks.size() == 2);
  CHECK(relative_error(peaks[0].frequency, 12.3) < 1e-5);
  CHECK(peaks[0].height == 1.0);
  CHECK(std::abs(peaks[1].frequency - 31.7) < 0.05);
  CHECK(std::abs(peaks[1].height / 0.01 - 1.0) < 0.05);
}

TEST_CASE("a drift that bends is no second oscillation")
{
  const Signal signal(2000, 5e-4, [](double t) { return std::cos(two_pi * 12.3 * t) + 0.3 * t * t * t; });

  const auto peaks = spectral_peaks(signal.times, signal.values, 2);

  REQUIRE(!peaks.empty());
  CHECK(relative_error(peaks[0].frequency, 12.3) < 1e-3); // the drift's leakage
  for (std::size_t i = 1; i < peaks.size(); ++i) CHECK(peaks[i].frequency > 1.8);
}

TEST_CASE("a spectrum without an oscillation has no tops")
{
  const Signal line(2000, 5e-4, [](double t) { return 3.0 - 2.0 * t; });

  CHECK(spectral_peaks(line.times, line.values, 2).empty());
}

TEST_CASE("the strongest of several oscillations wins, through noise")
{
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 0.1);
  const Signal signal(10000, 1e-3, [&](double t) {
    return std::sin(two_pi * 12.34 * t) + 0.5 * std::sin(two_pi * 50.0 * t) + noise(random);
  });

  // the bound of Cramer and Rao for this noise is 6e-6 of the frequency; the window costs some 2
  CHECK(relative_error(dominant_frequency(signal.times, signal.values), 12.34) < 5e-5);
}

TEST_CASE("fewer than two periods, a drift, a constant, a parabola and few samples have no frequency")
{
  const auto frequency_of = [](std::size_t n, const std::function<double(double)>& formula) {
    const Signal signal(n, 1e-3, formula);
    return dominant_frequency(signal.times, signal.values);
  };

  CHECK(frequency_of(1000, [](double t) { return std::sin(two_pi * 1.2 * t); }) == 0.0);
  CHECK(frequency_of(1000, [](double t) { return 3.0 * t; }) == 0.0);
  CHECK(frequency_of(1000, [](double) { return 1e5 / 3.0; }) == 0.0);
  CHECK(frequency_of(1000, [](double t) { return t * t; }) == 0.0);
  CHECK(frequency_of(5, [](double t) { return std::sin(1e3 * t); }) == 0.0);
  CHECK(dominant_frequency({}, {}) == 0.0);
  CHECK(frequency_of(1000, [](double t) { return std::sin(two_pi * 2.5 * t); }) > 2.3);
}

TEST_CASE("a shortened last step does not count, any other unequal step is an error")
{
  Signal signal(
      1001, 1e-3, [](double t) { return std::sin(two_pi * 20.0 * t); }, 5.0);
  const auto before = dominant_frequency(signal.times, signal.values);
  signal.times.push_back(signal.times.back() + 0.4e-3);
  signal.values.push_back(100.0);

  CHECK(dominant_frequency(signal.times, signal.values) == before);
  signal.times[500] += 0.3e-3;
  CHECK_THROWS_AS((void)dominant_frequency(signal.times, signal.values), Error);
}

TEST_CASE("samples that are not finite and lengths that differ are errors")
{
  Signal signal(100, 1e-3, [](double t) { return std::sin(300.0 * t); });
  signal.values[17] = std::numeric_limits<double>::quiet_NaN();

  CHECK_THROWS_WITH_AS((void)dominant_frequency(signal.times, signal.values), doctest::Contains("sample 17"), Error);
  CHECK_THROWS_AS((void)growth_rate(signal.times, signal.values, 10.0), Error);
  signal.values.pop_back();
  CHECK_THROWS_AS((void)dominant_frequency(signal.times, signal.values), Error);
}

TEST_CASE("growth and decay are found to rounding from a rough frequency")
{
  for (const double sigma : {-30.0, -2.0, -1e-3, 0.0, 0.5, 8.0, 60.0})
    for (const double start : {0.0, 100.0}) {
      const Signal signal(
          4000, 2.5e-4,
          [&](double t) {
            const double s = t - start;
            return 3.0 + 1e-3 * std::exp(sigma * s) * (std::cos(two_pi * 25.3 * s) + 0.4 * std::sin(two_pi * 25.3 * s));
          },
          start);

      const auto growth = growth_rate(signal.times, signal.values, 25.0); // 0.3 periods off over the record

      // the values carry 1e-13 of the oscillation's size in rounding at worst, sums and the times' rounding more
      CHECK(std::abs(growth.sigma - sigma) < 1e-7 * std::max(1.0, std::abs(sigma)));
      CHECK(relative_error(growth.frequency, 25.3) < 1e-8);
      CHECK(growth.relative_residual < 1e-8);
    }
}

TEST_CASE("dominant frequency and growth work together on a decaying oscillation")
{
  const Signal signal(5000, 1e-3, [](double t) { return std::exp(-0.4 * t) * std::sin(two_pi * 7.7 * t); });

  const auto frequency = dominant_frequency(signal.times, signal.values);
  const auto growth = growth_rate(signal.times, signal.values, frequency);

  CHECK(std::abs(growth.sigma + 0.4) < 1e-7);
  CHECK(relative_error(growth.frequency, 7.7) < 1e-8);
}

TEST_CASE("a drift under an oscillation leaves growth and frequency as they are")
{
  const Signal signal(4000, 2.5e-4,
                      [](double t) { return 0.3 - 2.0 * t + std::exp(-0.7 * t) * std::cos(two_pi * 25.3 * t); });

  const auto growth = growth_rate(signal.times, signal.values, 25.0);

  CHECK(std::abs(growth.sigma + 0.7) < 1e-7);
  CHECK(relative_error(growth.frequency, 25.3) < 1e-8);
  CHECK(growth.relative_residual < 1e-8);
}

TEST_CASE("unequal steps and noise are no obstacle for the growth, and the residual tells what is left")
{
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> step(0.5e-3, 1.5e-3);
  std::normal_distribution<double> noise(0.0, 0.1);
  std::vector<double> times, values;
  for (double t = 0.0; times.size() < 5000; t += step(random)) {
    times.push_back(t);
    values.push_back(std::exp(0.3 * t) * std::sin(two_pi * 5.0 * t) + noise(random));
  }

  const auto growth = growth_rate(times, values, 5.02);

  CHECK(std::abs(growth.sigma - 0.3) < 5e-3); // some five standard deviations: 0.1 / 1.5 sqrt(24 / 5000) / 5
  CHECK(growth.relative_residual == doctest::Approx(0.1 / 1.69).epsilon(0.1)); // rms of the sine: 1.69
}

TEST_CASE("nothing to fit gives the residual 1")
{
  const Signal constant(100, 1e-3, [](double) { return 2.0; });

  CHECK(growth_rate(constant.times, constant.values, 10.0).relative_residual == 1.0);
  CHECK(growth_rate(constant.times, constant.values, 0.0).relative_residual == 1.0);
  CHECK(growth_rate({}, {}, 10.0).relative_residual == 1.0);
}

TEST_CASE("a million samples take less than a second" * doctest::test_suite("full"))
{
  const Signal signal(1000000, 1e-5, [](double t) { return std::exp(0.1 * t) * std::sin(two_pi * 33.3 * t); });

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  const double limit = 10.0; // sanitizers cost that much
#else
  const double limit = 1.0;
#endif
  const auto begin = std::clock(); // this process's time: others on the machine do not count
  const auto frequency = dominant_frequency(signal.times, signal.values);
  const auto middle = std::clock();
  const auto growth = growth_rate(signal.times, signal.values, frequency);
  const auto end = std::clock();

  CHECK(std::abs(growth.sigma - 0.1) < 1e-8);
  CHECK(static_cast<double>(middle - begin) / CLOCKS_PER_SEC < limit);
  CHECK(static_cast<double>(end - middle) / CLOCKS_PER_SEC < limit);
}
