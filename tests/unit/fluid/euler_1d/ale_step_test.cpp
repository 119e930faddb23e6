// Invariants of one ALE step: geometric conservation, mass, energy, work, and no memory between
// steps.
#include "euler_1d/ale_step.hpp"

#include "euler_1d/initial_states.hpp"
#include "support/kernel_storage.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

using namespace mullion::euler_1d;
using mullion::testing::GasColumn;
using mullion::testing::worst;

namespace {

constexpr Gas air{1.4};
constexpr Reference reference{1.3, 1e5};
constexpr double c0 = 328.165; // for the step size only [m/s]

class Noise {
public:
  double operator()()
  {
    return 2.0 * static_cast<double>(engine_() >> 11) * 0x1p-53 - 1.0;
  } // [-1, 1)

private:
  std::mt19937_64 engine_{2011};
};

// Largest relative departure from a uniform flow between two walls that move with it, inner nodes
// at random.
double uniform_flow_error(double u, int n_steps)
{
  constexpr std::size_t n = 20;
  constexpr double dx = 1.0 / n;
  const double dt = 0.2 * dx / (c0 + std::abs(u));
  GasColumn column(n);
  const State state = column.state();
  set_equal_cells(state, 0.0, 1.0);
  set_uniform(state, air, {1.3, u, 1e5});
  Noise noise;
  std::vector<double> offset(n + 1, 0.0);
  for (int step = 0; step < n_steps; ++step) {
    for (std::size_t i = 0; i <= n; ++i) {
      const bool is_inner = i > 0 && i < n;
      const double target = is_inner ? 0.1 * dx * noise() : 0.0;
      const double swing =
          is_inner ? 20.0 * noise() : 0.0; // the two stages see different velocities
      const double mean = u + (target - offset[i]) / dt;
      column.w_begin[i] = mean + swing;
      column.w_end[i] = mean - swing;
      offset[i] = target;
    }
    advance(state, column.w_begin, column.w_end, dt, {}, column.workspace);
  }
  double error = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const Primitive q = cell_primitive(state, air, i);
    error = worst(error, std::abs(q.density / 1.3 - 1.0));
    error = worst(error, std::abs(q.pressure / 1e5 - 1.0));
    error = worst(error, std::abs(q.velocity - u) / c0);
  }
  return error;
}

// A column with waves of finite size in it.
GasColumn wavy_column(std::size_t n)
{
  GasColumn column(n);
  const State state = column.state();
  set_equal_cells(state, 0.0, 1.0);
  for (std::size_t i = 0; i < n; ++i) {
    const double x = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    set_cell(state, air, i,
             {1.3 + 0.2 * std::sin(7.0 * x), 40.0 * std::sin(3.0 * x),
              1e5 * (1.0 + 0.2 * std::cos(5.0 * x))});
  }
  return column;
}

} // namespace

TEST_CASE(
    "a uniform flow stays uniform while the inner nodes move at random (geometric conservation)")
{
  // Round-off only: each step adds some 1e-16, waves carry it about and the scheme damps it.
  CHECK(uniform_flow_error(0.0, 2000) < 1e-12);
  CHECK(uniform_flow_error(25.0, 2000) < 1e-12);
}

TEST_SUITE("full")
{
  TEST_CASE("a uniform flow stays uniform over 20,000 steps with nodes that move at random")
  {
    CHECK(uniform_flow_error(0.0, 20000) < 1e-12);
    CHECK(uniform_flow_error(25.0, 20000) < 1e-12);
  }
}

TEST_CASE("a closed column keeps its mass and energy")
{
  for (const Limiter limiter : {Limiter::none, Limiter::van_albada}) {
    GasColumn column = wavy_column(40);
    const Totals before = totals(column.state());

    for (int step = 0; step < 1000; ++step)
      column.advance(0.0, 0.0, 0.3 / 40 / c0, {.limiter = limiter});

    const Totals after = totals(column.state());
    // 1000 steps with round-off of 1e-16 each that does not all have one sign
    CHECK(std::abs(after.mass - before.mass) < 1e-13 * before.mass);
    CHECK(std::abs(after.energy - before.energy) < 1e-13 * before.energy);
  }
}

TEST_CASE("the gas loses exactly the energy that it gives the wall as work, and no mass")
{
  GasColumn column = wavy_column(40);
  const Totals before = totals(column.state());
  const double dt = 0.3 / 40 / c0;
  const auto wall_velocity = [](double t) { return 20.0 * std::sin(900.0 * t) + 5.0; };

  WallIntegrals sum;
  for (int step = 0; step < 1000; ++step)
    sum += column.advance(wall_velocity(step * dt), wall_velocity((step + 1) * dt), dt);

  const Totals after = totals(column.state());
  CHECK(std::abs(sum.work) > 0.01 * before.energy); // the test would be empty otherwise
  CHECK(std::abs(before.energy - after.energy - sum.work) < 1e-13 * before.energy); // round-off
  CHECK(std::abs(after.mass - before.mass) < 1e-13 * before.mass);
  CHECK(column.node_x.back() - 1.0 == doctest::Approx(sum.swept_volume).epsilon(1e-13));
}

TEST_CASE(
    "gas at rest presses on a resting wall with its pressure times the time, and does no work")
{
  GasColumn column(20);
  set_rest(column.state(), air, reference, 1.0);

  const WallIntegrals wall = column.advance(0.0, 0.0, 1e-5);

  CHECK(wall.impulse == doctest::Approx(1.0).epsilon(1e-14)); // 1e5 Pa for 1e-5 s
  CHECK(wall.work == 0.0);
  CHECK(std::abs(totals(column.state()).momentum) < 1e-14);
}

TEST_CASE("lengths and node distances agree after many steps")
{
  GasColumn column = wavy_column(10);

  for (int step = 0; step < 500; ++step)
    column.advance(10.0 * std::sin(0.1 * step), 10.0 * std::sin(0.1 * (step + 1)), 5e-5);

  for (std::size_t i = 0; i < 10; ++i)
    CHECK(std::abs(column.node_x[i + 1] - column.node_x[i] - column.length[i]) <
          1e-14); // round-off
}

TEST_CASE("the wall work and impulse weigh both stages with one half")
{
  // In gas at rest the first stage sees p_0 - z w_begin on the wall exactly.
  GasColumn column(10);
  set_rest(column.state(), air, reference, 1.0);
  const double z = impedance(air, {1.3, 0.0, 1e5});
  const double w =
      1e-3; // small: the second stage then sees p_0 - z w to second order in the Courant number
  const double dt = 1e-9;

  const WallIntegrals wall = column.advance(w, 3.0 * w, dt);

  CHECK(wall.impulse / dt - 1e5 ==
        doctest::Approx(-2.0 * z * w).epsilon(1e-4)); // Courant number 3e-6
  CHECK(wall.work / dt == doctest::Approx(1e5 * 2.0 * w - z * w * w * 5.0).epsilon(1e-9));
  CHECK(wall.swept_volume == doctest::Approx(2.0 * w * dt).epsilon(1e-15));
}

TEST_CASE("a step does not depend on what the workspace held before")
{
  GasColumn fresh = wavy_column(15);
  GasColumn used = wavy_column(15);
  for (auto* stage : {&used.workspace.mass, &used.workspace.momentum, &used.workspace.energy,
                      &used.workspace.length})
    std::fill(stage->begin(), stage->end(), std::nan(""));

  fresh.advance(3.0, 4.0, 2e-5);
  used.advance(3.0, 4.0, 2e-5);

  CHECK(fresh.mass == used.mass); // bit for bit
  CHECK(fresh.momentum == used.momentum);
  CHECK(fresh.energy == used.energy);
}
