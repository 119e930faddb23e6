// The gas kernel against exact solutions: second order for smooth waves with resting and moving
// wall, a shock tube, and a pulse that leaves through the open end.
#include "euler_1d/ale_step.hpp"

#include "euler_1d/initial_states.hpp"
#include "euler_1d/wall.hpp"
#include "support/kernel_storage.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace mullion::euler_1d;
using mullion::testing::GasColumn;
using mullion::testing::worst;

namespace {

constexpr Gas air{1.4};
constexpr Reference reference{1.3, 1e5};
const double c = std::sqrt(1.4e5 / 1.3);
const double z = 1.3 * c;

struct ModeErrors {
  double cells;         // mean over the cells of |p error| + z |u error|, of the amplitude of p'
  double wall_pressure; // largest over time, of the amplitude of p'
};

// Run an acoustic mode whose wall moves as the linear solution says, one period, Courant number
// 0.4.
ModeErrors mode_errors(std::size_t n, double k)
{
  const double omega = k * c;
  // Relative strength 1e-7: nonlinear terms stay below the discretisation error of the finest mesh,
  // round-off too.
  const AcousticMode mode{1e-7, omega, 1.0};
  const double period = 2.0 * std::numbers::pi / omega;
  const auto n_steps = static_cast<int>(std::ceil(period * c * static_cast<double>(n) / 0.4));
  const double dt = period / n_steps;
  const double scale = z * omega * mode.amplitude / std::sin(k);
  const auto wall_velocity = [&](double t) { return -mode.amplitude * omega * std::sin(omega * t); };
  GasColumn column(n);
  set_acoustic_mode(column.state(), air, reference, mode, 0.0, 1.0 + mode.amplitude);
  std::vector<double> begin_pressure(n), density(n), velocity(n), pressure(n);
  cell_fields(column.state(), air, density, velocity, begin_pressure);

  ModeErrors errors{0.0, 0.0};
  for (int step = 0; step < n_steps; ++step) {
    const double t = (step + 1) * dt;
    column.advance(wall_velocity(step * dt), wall_velocity(t), dt);
    const double exact = 1e5 - scale * std::cos(k) * std::cos(omega * t);
    const double found = wall_state(column.state(), air, wall_velocity(t)).pressure;
    errors.wall_pressure = worst(errors.wall_pressure, std::abs(found - exact) / scale);
  }
  cell_fields(column.state(), air, density, velocity, pressure);
  for (std::size_t i = 0; i < n; ++i) // after a period the exact solution is the initial state; u shows phase errors
    errors.cells +=
        (std::abs(pressure[i] - begin_pressure[i]) + z * std::abs(velocity[i])) / scale / static_cast<double>(n);
  return errors;
}

// A standing wave between resting walls, p' = cos(pi x), one period; mean error of p' over its
// amplitude.
double standing_wave_error(std::size_t n)
{
  const double k = std::numbers::pi;
  const double period = 2.0 / c;
  const auto n_steps = static_cast<int>(5 * n); // Courant number 0.4
  GasColumn column(n);
  set_equal_cells(column.state(), 0.0, 1.0);
  std::vector<double> exact(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double half = 0.5 * k / static_cast<double>(n);
    const double dp =
        0.01 * std::cos(k * (static_cast<double>(i) + 0.5) / static_cast<double>(n)) * std::sin(half) / half;
    exact[i] = 1e5 + dp;
    set_cell(column.state(), air, i, {1.3 * (1.0 + dp / 1.4e5), 0.0, exact[i]});
  }
  for (int step = 0; step < n_steps; ++step) column.advance(0.0, 0.0, period / n_steps);
  double error = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Primitive q = cell_primitive(column.state(), air, i);
    error += (std::abs(q.pressure - exact[i]) + z * std::abs(q.velocity)) / 0.01 / static_cast<double>(n);
  }
  return error;
}

} // namespace

TEST_CASE("a standing wave between resting walls converges with second order")
{
  const double e20 = standing_wave_error(20);
  const double e40 = standing_wave_error(40);
  const double e80 = standing_wave_error(80);
  INFO("errors " << e20 << " " << e40 << " " << e80);

  CHECK(std::log2(e20 / e40) > 1.9); // 2 less what the next order takes on these meshes
  CHECK(std::log2(e40 / e80) > 1.9);
  // Phase error of a period, (k dx)^2 (1/12 from Fromm's scheme + 0.4^2/6 from Heun's) 2 pi, times
  // the mean of |sin|.
  CHECK(e80 < 1e-3); // that is 6.8e-4
}

TEST_CASE("a mode driven by the moving wall converges with second order, its wall pressure too")
{
  const ModeErrors e20 = mode_errors(20, 0.8);
  const ModeErrors e40 = mode_errors(40, 0.8);
  const ModeErrors e80 = mode_errors(80, 0.8);
  INFO("cells " << e20.cells << " " << e40.cells << " " << e80.cells);
  INFO("wall " << e20.wall_pressure << " " << e40.wall_pressure << " " << e80.wall_pressure);

  CHECK(std::log2(e40.cells / e80.cells) > 1.9);
  CHECK(std::log2(e40.wall_pressure / e80.wall_pressure) > 1.9);
  CHECK(e80.wall_pressure < 2e-5); // the extrapolation error alone is dx^2 (p_xx + z u_xx) / 3 = 1.7e-5 at most
}

TEST_CASE("the wall's pressure gradient converges with first order, with the error of the "
          "extrapolated wall pressure")
{
  // Taylor series of the cell means: p_w is too low by dx^2 (p_xx + z u_xx) / 3, hence the gradient
  // by dx (p_xx + 8/9 z u_xx), where the parabola through exact point values would be second order.
  const double k = 0.8;
  const double omega = k * c;
  const AcousticMode mode{1e-7, omega, 1.0};
  const double scale = z * omega * mode.amplitude / std::sin(k);
  const double t = 0.3 / omega;
  const double gradient = scale * k * std::sin(k) * std::cos(0.3);
  const double p_xx = scale * k * k * std::cos(k) * std::cos(0.3);
  const double z_u_xx = scale * k * k * std::sin(k) * std::sin(0.3);

  for (const std::size_t n : {80, 160}) {
    GasColumn column(n);
    set_acoustic_mode(column.state(), air, reference, mode, t, 1.0);
    const double w = -mode.amplitude * omega * std::sin(0.3);

    const double error = wall_state(column.state(), air, w).pressure_gradient - gradient;

    const double expected = -(p_xx + 8.0 / 9.0 * z_u_xx) / static_cast<double>(n);
    CHECK(error == doctest::Approx(expected).epsilon(0.01)); // the next term is dx smaller
  }
}

TEST_CASE("Sod's shock tube with van Albada's limiter has the exact plateaus and no overshoot")
{
  // Exact: p* = 0.30313, u* = 0.92745, rho*_L = 0.42632, rho*_R = 0.26557 (Toro 2009, section 4.3,
  // test 1). Diaphragm at 0.5, t = 0.2: contact at 0.6855, shock at 0.8504, tail of the expansion
  // at 0.4859.
  const std::size_t n = 200;
  GasColumn column(n);
  set_equal_cells(column.state(), 0.0, 1.0);
  for (std::size_t i = 0; i < n; ++i)
    set_cell(column.state(), air, i, i < n / 2 ? Primitive{1.0, 0.0, 1.0} : Primitive{0.125, 0.0, 0.1});

  for (int step = 0; step < 200; ++step) column.advance(0.0, 0.0, 1e-3, {.limiter = Limiter::van_albada});

  for (std::size_t i = 0; i < n; ++i) {
    const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    const Primitive q = cell_primitive(column.state(), air, i);
    CHECK(q.density < 1.0 + 1e-3); // no new extrema beyond 0.1 %
    CHECK(q.density > 0.125 * (1.0 - 1e-3));
    if (x > 0.52 && x < 0.82) { // a few cells off the tail and the shock, which smear over two or three cells
      CHECK(q.pressure == doctest::Approx(0.30313).epsilon(0.01));
      CHECK(q.velocity == doctest::Approx(0.92745).epsilon(0.01));
    }
    if (x > 0.52 && x < 0.65)
      CHECK(q.density == doctest::Approx(0.42632).epsilon(0.01)); // left of the contact, which smears more
    if (x > 0.73 && x < 0.82) CHECK(q.density == doctest::Approx(0.26557).epsilon(0.01));
  }
}

TEST_CASE("a pulse leaves through the open end and comes back from the closed one")
{
  const auto left_behind = [](LeftEnd end) {
    const std::size_t n = 100;
    const double strength = 1.0; // Pa: linear
    GasColumn column(n);
    set_equal_cells(column.state(), 0.0, 1.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
      const double dp = strength * std::exp(-std::pow((x - 0.5) / 0.1, 2.0));
      set_cell(column.state(), air, i, {1.3 * (1.0 + dp / 1.4e5), -dp / z, 1e5 + dp}); // runs to the left
    }
    const double dt = 0.4 * 0.01 / c;
    for (int step = 0; step < 230; ++step) // 0.92 L / c: the reflection would be at 0.42
      column.advance(0.0, 0.0, dt, {.left_end = end, .reference = reference});
    double largest = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      largest = worst(largest, std::abs(cell_primitive(column.state(), air, i).pressure - 1e5));
    return largest / strength;
  };

  CHECK(left_behind(LeftEnd::open) < 2e-3); // reconstruction error at the end, dx^2 / width^2 times a small factor
  CHECK(left_behind(LeftEnd::closed) > 0.95);
}
