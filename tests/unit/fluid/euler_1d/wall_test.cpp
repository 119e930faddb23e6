// Pressure and pressure gradient at the moving wall.
#include "euler_1d/wall.hpp"

#include "euler_1d/initial_states.hpp"
#include "support/kernel_storage.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::euler_1d;
using mullion::testing::GasColumn;

namespace {

constexpr Gas air{1.4};
constexpr Reference reference{1.3, 1e5};
constexpr Primitive rest{1.3, 0.0, 1e5};

} // namespace

TEST_CASE(
    "the wall pressure is the acoustic one, with the second-order error of the exact simple wave")
{
  // A wall that starts to move with w sends a simple wave into gas at rest (w > 0: an expansion,
  // exact): p / p_0 = (1 - (gamma - 1)/2 M)^(2 gamma / (gamma - 1)) = 1 - gamma M + gamma (gamma +
  // 1)/4 M^2 - ...
  for (const double mach : {1e-4, 1e-3, 1e-2}) {
    const double exact = 1e5 * std::pow(1.0 - 0.2 * mach, 7.0);

    const double found = wall_pressure(air, rest, mach * sound_speed(air, rest));

    const double remainder = (exact - found) / (1e5 * mach * mach);
    CHECK(remainder ==
          doctest::Approx(0.84).epsilon(0.01)); // gamma (gamma + 1) / 4; next term: M * 0.4
  }
}

TEST_CASE("a wall that moves with the gas feels its pressure")
{
  CHECK(wall_pressure(air, {1.3, 7.0, 1.2e5}, 7.0) == 1.2e5);
}

TEST_CASE("the wall state of a uniform gas is the gas, without gradient")
{
  GasColumn column(8);
  set_rest(column.state(), air, reference, 2.0);

  const WallState wall = wall_state(column.state(), air, 0.0);

  CHECK(wall.pressure == doctest::Approx(1e5).epsilon(1e-15));
  CHECK(std::abs(wall.pressure_gradient) < 1e-14 * 1e5 / 0.25); // round-off of p / dx
  CHECK(wall.density == doctest::Approx(1.3).epsilon(1e-15));
  CHECK(wall.sound_speed == doctest::Approx(std::sqrt(1.4e5 / 1.3)).epsilon(1e-15));
  CHECK(wall.spacing == 0.25);
}

TEST_CASE("the pressure gradient at the wall is exact for a parabola through the points it uses")
{
  GasColumn column(3);
  const State state = column.state();
  state.length[0] = 0.2;
  state.length[1] = 0.3;
  state.length[2] = 0.1; // wall at 0, centres at -0.05 and -0.25
  const auto parabola = [](double x) { return 1e5 + 2e3 * x - 5e3 * x * x; };
  set_cell(state, air, 0, rest);
  set_cell(state, air, 1, {1.3, 0.0, parabola(-0.25)});
  set_cell(state, air, 2, {1.3, 0.0, parabola(-0.05)});
  // The wall velocity with which the wall pressure is the parabola's: p + z (0 - w) = 1e5.
  const double p_face = parabola(-0.05) + (parabola(-0.05) - parabola(-0.25)) * 0.25;
  const double w = (p_face - 1e5) / std::sqrt(1.4 * p_face * 1.3);

  const WallState wall = wall_state(state, air, w);

  CHECK(wall.pressure == doctest::Approx(1e5).epsilon(1e-15));
  CHECK(wall.pressure_gradient ==
        doctest::Approx(2e3).epsilon(1e-11)); // round-off: 1e5 / 0.05 against 2e3
}

TEST_CASE("on equal cells the gradient is (8/3 p_w - 3 p_N + 1/3 p_{N-1}) / dx")
{
  GasColumn column(4);
  const State state = column.state();
  set_rest(state, air, reference, 4.0);
  set_cell(state, air, 2, {1.3, 0.0, 1.1e5});
  set_cell(state, air, 3, {1.3, 0.0, 1.4e5});

  const WallState wall = wall_state(state, air, 0.0);

  const double expected = 8.0 / 3.0 * wall.pressure - 3.0 * 1.4e5 + 1.1e5 / 3.0;
  CHECK(wall.pressure == doctest::Approx(1.55e5).epsilon(1e-15));
  CHECK(wall.pressure_gradient == doctest::Approx(expected).epsilon(1e-13)); // differences of 1e5
}
