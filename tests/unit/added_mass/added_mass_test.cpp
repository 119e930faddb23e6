// The added mass of a channel's wall: against the potential flow that it stands for, and against its own spectrum.
#include "added_mass_fluid/added_mass.hpp"

#include "support/worst.hpp"

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

using namespace mullion::added_mass_fluid;
using mullion::testing::worst;

namespace {

constexpr Channel channel{.n_points = 100, .length = 6.0, .radius = 0.5, .density = 1.0};

/// phi / phi' at y = radius for phi'' = kappa^2 phi, phi'(0) = 0, by the classical Runge-Kutta method.
double potential_over_slope(double kappa, double radius)
{
  constexpr int n = 1000;
  const double h = radius / n, k2 = kappa * kappa;
  double phi = 1.0, slope = 0.0;
  for (int i = 0; i < n; ++i) {
    const double a1 = slope, b1 = k2 * phi;
    const double a2 = slope + 0.5 * h * b1, b2 = k2 * (phi + 0.5 * h * a1);
    const double a3 = slope + 0.5 * h * b2, b3 = k2 * (phi + 0.5 * h * a2);
    const double a4 = slope + h * b3, b4 = k2 * (phi + h * a3);
    phi += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    slope += h / 6.0 * (b1 + 2.0 * b2 + 2.0 * b3 + b4);
  }
  return phi / slope;
}

std::vector<double> sine(std::size_t mode, double amplitude = 1.0)
{
  std::vector<double> s(channel.n_points);
  for (std::size_t i = 0; i < s.size(); ++i)
    s[i] = amplitude * std::sin(std::numbers::pi * static_cast<double>(mode * (i + 1)) / 101.0);
  return s;
}

} // namespace

TEST_CASE("the added mass of a mode is that of the potential flow below it")
{
  for (const std::size_t mode : {1, 2, 5, 10}) {
    const double flow = potential_over_slope(static_cast<double>(mode) * std::numbers::pi / 6.0, 0.5);

    // kappa h <= 2.6e-3: the method's own error, (kappa h)^4 / 120 relative a unit of kappa y, is below 1e-12.
    CHECK(std::abs(eigenvalue(channel, mode) - flow) < 2e-12 * flow);
  }
}

TEST_CASE("the added-mass matrix has the modes' added masses as its spectrum, and no other")
{
  const auto matrix = added_mass_matrix(channel);
  const Eigen::Map<const Eigen::MatrixXd> m(matrix.data(), 100, 100);

  const Eigen::VectorXd spectrum = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(m).eigenvalues(); // ascending

  const bool is_symmetric = m == m.transpose();
  CHECK(is_symmetric);
  double largest = 0.0;
  for (std::size_t k = 1; k <= 100; ++k)
    largest = worst(largest, std::abs(spectrum(static_cast<Eigen::Index>(100 - k)) - eigenvalue(channel, k)));
  CHECK(largest < 100 * 2.2e-16 * eigenvalue(channel, 1)); // backward error of a solver for 100 x 100: n eps |M|
}

TEST_CASE("a wall that accelerates out of the fluid in one mode feels a suction in that mode")
{
  const auto matrix = added_mass_matrix(channel);
  Channel water = channel;
  water.density = 1000.0;
  const double dt = 1e-3;
  for (const std::size_t mode : {1, 2, 37, 100}) {
    const auto s = sine(mode);
    // eta = (t + dt)^2 / 2 s + 0.1 t s: acceleration s, and a velocity that must not matter
    const auto before = sine(mode, -0.1 * dt), now = sine(mode, 0.5 * dt * dt),
               next = sine(mode, 2.0 * dt * dt + 0.1 * dt);
    std::vector<double> p(100);

    wall_pressure(water, matrix, {next, now, before}, dt, p);

    const double mu = 6.0 / (static_cast<double>(mode) * std::numbers::pi *
                             std::tanh(static_cast<double>(mode) * std::numbers::pi / 12.0));
    double largest = 0.0;
    for (std::size_t i = 0; i < 100; ++i) largest = worst(largest, std::abs(p[i] + 1000.0 * mu * s[i]));
    // The second difference cancels eta of 1e-4 in 1e-6 and has noise in all modes, which mode 1 weighs most.
    CHECK(largest < 1e3 * eigenvalue(channel, 1) * 4 * 2.2e-16 * 1e-4 / (dt * dt));
  }
}

TEST_CASE("a wall in uniform motion feels nothing")
{
  const auto matrix = added_mass_matrix(channel);
  const auto before = sine(3, 0.0), now = sine(3, 0.125), next = sine(3, 0.25); // powers of two: no round-off
  std::vector<double> p(100, 1.0);

  wall_pressure(channel, matrix, {next, now, before}, 1e-4, p);

  for (const double value : p) CHECK(value == 0.0);
}

TEST_CASE("the work on the wall is pressure times displacement times spacing")
{
  const Channel two_points{.n_points = 2, .length = 1.5, .radius = 1.0, .density = 1.0};
  const std::vector<double> p = {1.0, 2.0}, now = {0.5, 1.0}, next = {3.5, 0.5};

  CHECK(wall_work(two_points, p, {next, now, now}) == 1.0); // (1 * 3 + 2 * (-0.5)) * 0.5
}
