// The generalised string: its equation point by point, one mode by hand, the balance of energy, the pulse.
#include "string_1d/implicit_euler.hpp"

#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

using namespace mullion::string_1d;
using mullion::testing::worst;

namespace {

constexpr ElasticString light{
    .n_points = 100, .length = 6.0, .thickness = 0.1, .density = 1.1, .stiffness = 4e5, .tension = 2.5e4};
constexpr double dt = 1e-4;

std::vector<double> rough(double amplitude, double phase)
{
  std::vector<double> values(100);
  for (std::size_t i = 0; i < values.size(); ++i)
    values[i] = amplitude * (std::sin(1.7 * static_cast<double>(i) + phase) + (i % 5 == 0 ? 0.5 : 0.0));
  return values;
}

} // namespace

TEST_CASE("a step fulfils the string's equation at every point, with fixed ends")
{
  const auto p = rough(2e4, 0.0), now = rough(1e-2, 1.0), before = rough(1e-2, 2.0);
  std::vector<double> next(100);

  implicit_euler(light, p, now, before, dt, next);

  const double dx = 6.0 / 101.0;
  double largest = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < 100; ++i) {
    const double left = i == 0 ? 0.0 : next[i - 1], right = i == 99 ? 0.0 : next[i + 1];
    const double inertia = 0.11 * (next[i] - 2.0 * now[i] + before[i]) / (dt * dt);
    const double elastic = 4e5 * next[i] - 2.5e4 * (right - 2.0 * next[i] + left) / (dx * dx);
    largest = worst(largest, std::abs(inertia + elastic - p[i]));
    scale = std::max(scale, (0.11 / (dt * dt) + 4e5 + 5e4 / (dx * dx)) * std::abs(next[i]));
  }
  CHECK(largest < 20 * 2.2e-16 * scale); // Thomas on a diagonally dominant matrix is backward stable: a few eps
}

TEST_CASE("a mode of pressure moves a string at rest in that mode")
{
  for (const int mode : {1, 2, 50, 100}) {
    std::vector<double> p(100), rest(100, 0.0), next(100);
    for (std::size_t i = 0; i < 100; ++i) p[i] = std::sin(std::numbers::pi * static_cast<double>(i + 1) * mode / 101.0);

    implicit_euler(light, p, rest, rest, dt, next);

    const double half_angle = std::sin(std::numbers::pi * mode / 202.0), dx = 6.0 / 101.0;
    const double impedance = 0.11 / (dt * dt) + 4e5 + 4.0 * 2.5e4 / (dx * dx) * half_angle * half_angle;
    double largest = 0.0;
    for (std::size_t i = 0; i < 100; ++i) largest = worst(largest, std::abs(next[i] * impedance - p[i]));
    CHECK(largest < 1e-12); // sines of arguments up to 314: 314 eps = 7e-14
  }
}

TEST_CASE("a string of one point is a mass on two springs")
{
  const ElasticString one{
      .n_points = 1, .length = 2.0, .thickness = 0.5, .density = 4.0, .stiffness = 3.0, .tension = 1.5};
  const std::vector<double> p = {6.0}, now = {1.0}, before = {2.0};
  std::vector<double> next(1);

  implicit_euler(one, p, now, before, 1.0, next);

  CHECK(next[0] == 0.75); // (2 + 3 + 2 * 1.5) eta = 6 + 2 * (2 * 1 - 2)
}

TEST_CASE("the string's energy changes by the work done on it, less what implicit Euler takes out")
{
  auto before = rough(1e-2, 0.0), now = rough(1e-2, 0.2);
  double throughput = 0.0, largest = 0.0;
  for (int step = 0; step < 200; ++step) {
    const auto p = rough(2e4, 0.3 * step);
    std::vector<double> next(100), v_now(100), v_next(100), change(100), v_change(100);

    implicit_euler(light, p, now, before, dt, next);

    for (std::size_t i = 0; i < 100; ++i) {
      v_now[i] = (now[i] - before[i]) / dt;
      v_next[i] = (next[i] - now[i]) / dt;
      change[i] = next[i] - now[i];
      v_change[i] = v_next[i] - v_now[i];
    }
    // Implicit Euler in (eta, v), multiplied with the change: 2 a (a - b) = a^2 - b^2 + (a - b)^2.
    const double gain = kinetic_energy(light, v_next) - kinetic_energy(light, v_now) + elastic_energy(light, next) -
                        elastic_energy(light, now);
    const double taken_out = kinetic_energy(light, v_change) + elastic_energy(light, change);
    const double done = work(light, p, next, now);
    throughput = std::max({throughput, std::abs(done), kinetic_energy(light, v_now), elastic_energy(light, now)});
    largest = worst(largest, std::abs(gain + taken_out - done));
    before = now;
    now = next;
  }

  CHECK(throughput > 1.0);
  CHECK(largest < 1e-12 * throughput); // round-off: sums of 100, and a velocity whose eta cancels two digits
}

TEST_CASE("energies and work of a string of two points are those by hand")
{
  const ElasticString two{
      .n_points = 2, .length = 1.5, .thickness = 0.5, .density = 4.0, .stiffness = 3.0, .tension = 1.5};
  const std::vector<double> a = {1.0, 2.0}, b = {0.5, 0.5};

  CHECK(kinetic_energy(two, a) == 2.5);         // 2/2 * 5 * 0.5
  CHECK(elastic_energy(two, a) == 12.75);       // (3 * 5 + 1.5 * (4 + 4 + 16)) / 2 * 0.5
  CHECK(work(two, {{3.0, -1.0}}, a, b) == 0.0); // (3 * 0.5 - 1 * 1.5) * 0.5
}

TEST_CASE("the pulse is a bump around x = 1.5 m, and is gone in steps that begin at its end")
{
  const Pulse pulse{.pressure = 2e4, .end = 5e-3};

  CHECK(pulse_pressure(pulse, 1.5, 0.0) == 2e4);
  CHECK(pulse_pressure(pulse, 2.0, 4.9e-3) == doctest::Approx(2e4 / std::numbers::e)); // 4 * 0.5^2 = 1
  CHECK(pulse_pressure(pulse, 1.0, 4.9e-3) == doctest::Approx(2e4 / std::numbers::e));
  CHECK(pulse_pressure(pulse, 1.5, 5e-3) == 0.0);
}
