// Cell values and the check that finds the first unsound cell.
#include "euler_1d/state.hpp"

#include "euler_1d/initial_states.hpp"
#include "support/kernel_storage.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace mullion::euler_1d;
using mullion::testing::GasColumn;

namespace {

constexpr Gas air{1.4};

GasColumn sound_column()
{
  GasColumn column(5);
  set_rest(column.state(), air, Reference{1.3, 1e5}, 1.0);
  return column;
}

} // namespace

TEST_CASE("cell fields give back what was put into the cells")
{
  auto column = sound_column();
  set_cell(column.state(), air, 2, {1.7, -3.0, 1.2e5});
  std::vector<double> density(5), velocity(5), pressure(5);

  cell_fields(column.state(), air, density, velocity, pressure);

  CHECK(density[2] == doctest::Approx(1.7).epsilon(1e-15));
  CHECK(velocity[2] == doctest::Approx(-3.0).epsilon(1e-15));
  CHECK(pressure[2] == doctest::Approx(1.2e5).epsilon(1e-15));
  CHECK(velocity[1] == 0.0);
}

TEST_CASE("a sound column has no bad cell")
{
  auto column = sound_column();

  CHECK_FALSE(find_bad_cell(column.state(), air).has_value());
}

TEST_CASE("the first bad cell is found with its fault and value")
{
  auto column = sound_column();
  SUBCASE("density")
  {
    column.mass[3] = -0.26;
    column.mass[4] = -1.0;
    const auto bad = find_bad_cell(column.state(), air);
    REQUIRE(bad.has_value());
    CHECK(bad->cell == 3);
    CHECK(bad->fault == Fault::density);
    CHECK(bad->value == doctest::Approx(-1.3)); // -0.26 kg in 0.2 m
    CHECK(std::string(to_string(bad->fault)) == "density not positive");
  }
  SUBCASE("pressure")
  {
    column.momentum[1] = 0.26 * 1000.0; // kinetic energy beyond the total
    const auto bad = find_bad_cell(column.state(), air);
    REQUIRE(bad.has_value());
    CHECK(bad->cell == 1);
    CHECK(bad->fault == Fault::pressure);
    CHECK(bad->value < 0.0);
  }
  SUBCASE("length")
  {
    column.length[0] = 0.0;
    const auto bad = find_bad_cell(column.state(), air);
    REQUIRE(bad.has_value());
    CHECK(bad->cell == 0);
    CHECK(bad->fault == Fault::length);
    CHECK(bad->value == 0.0);
  }
  SUBCASE("not a number")
  {
    column.energy[4] = std::numeric_limits<double>::quiet_NaN();
    const auto bad = find_bad_cell(column.state(), air);
    REQUIRE(bad.has_value());
    CHECK(bad->cell == 4);
    CHECK(bad->fault == Fault::non_finite);
  }
}
