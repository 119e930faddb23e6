// Predictors are exact where their order says so, with equal steps and with steps of varying size.
#include <mullion/coupling/predictor.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

using namespace mullion;

namespace {

constexpr double rounding = 1e-14; // a handful of operations on numbers of the order of 1

} // namespace

TEST_CASE("the predicted velocity is exact where the acceleration is linear in time, whatever the steps")
{
  const auto velocity = [](double t) { return 0.3 + 2.0 * t - 1.5 * t * t; };
  const auto acceleration = [](double t) { return 2.0 - 3.0 * t; };
  for (const double ratio : {1.0, 0.37, 1.9}) {
    const double before = 0.1, dt = ratio * before, t = 0.4;

    const double predicted = predicted_velocity(velocity(t), acceleration(t), acceleration(t - before), dt, ratio);

    CHECK(std::abs(predicted - velocity(t + dt)) < rounding);
  }
}

TEST_CASE("the predicted velocity has the published factors where steps are equal")
{
  CHECK(predicted_velocity(1.0, 8.0, 4.0, 0.5, 1.0) == 1.0 + 0.5 * (1.5 * 8.0 - 0.5 * 4.0));
  CHECK(predicted_velocity(1.0, 8.0, 4.0, 0.5, 1.0, 1.0, 0.0) == 1.0 + 0.5 * 8.0);
}

TEST_CASE("the error of the predicted velocity is of third order in a step")
{
  const auto error = [](double dt) {
    return std::abs(predicted_velocity(std::sin(1.0), std::cos(1.0), std::cos(1.0 - dt), dt, 1.0) - std::sin(1.0 + dt));
  };

  // 8 in the limit; the next term is dt |v''''/v'''| ~ 2 dt of it, at dt = 0.01
  CHECK(error(0.01) / error(0.005) == doctest::Approx(8.0).epsilon(0.02));
}

TEST_CASE("linear extrapolation continues a line over steps of any size")
{
  const auto line = [](double t) { return 2.0 - 3.0 * t; };

  CHECK(std::abs(extrapolated_linearly(line(1.0), line(0.9), 1.0) - line(1.1)) < rounding);
  CHECK(std::abs(extrapolated_linearly(line(1.0), line(0.9), 0.4) - line(1.04)) < rounding);
}

TEST_CASE("quadratic extrapolation continues a parabola over equal steps")
{
  const auto parabola = [](double t) { return 2.0 - 3.0 * t + 5.0 * t * t; };

  CHECK(std::abs(extrapolated_quadratically(parabola(1.0), parabola(0.9), parabola(0.8)) - parabola(1.1)) < rounding);
}
