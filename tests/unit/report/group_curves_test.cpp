// Which columns of a history share a plot.
#include "report/group_curves.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <map>
#include <string>
#include <vector>

using namespace mullion::report;

namespace {

using Names = std::vector<std::string>;

CsvTable history(const std::vector<std::pair<std::string, std::vector<double>>>& columns)
{
  CsvTable table;
  table.columns = {{"step", {0, 1}, {}}, {"time", {0, 0.1}, {}}};
  for (const auto& [name, values] : columns) table.columns.push_back({name, values, {}});
  table.n_rows = 2;
  return table;
}

Names names(const CurveGroup& group)
{
  Names found;
  for (const auto* column : group.columns) found.push_back(column->name);
  return found;
}

} // namespace

TEST_CASE("quantities of one unit share a plot, others do not; motion comes before traction")
{
  const auto table = history({{"fluid.wall.traction", {0, 1}},
                              {"structure.wet.traction", {0, 2}},
                              {"fluid.wall.velocity", {-1, 1}},
                              {"structure.wet.velocity", {0, 1}},
                              {"structure.wet.displacement", {0, 1}}});
  const std::map<std::string, std::string> units = {{"fluid.wall.traction", "Pa"},
                                                    {"structure.wet.traction", "Pa"},
                                                    {"fluid.wall.velocity", "m/s"},
                                                    {"structure.wet.velocity", "m/s"},
                                                    {"structure.wet.displacement", "m"}};

  const auto groups = group_curves(table, units);

  REQUIRE(groups.size() == 3);
  CHECK(names(groups[0]) == Names{"structure.wet.displacement"});
  CHECK(names(groups[1]) == Names{"fluid.wall.velocity", "structure.wet.velocity"});
  CHECK(groups[1].unit == "m/s");
  CHECK(names(groups[2]) == Names{"fluid.wall.traction", "structure.wet.traction"});
  for (const auto& group : groups) CHECK(group.section == Section::interface);
}

TEST_CASE("a column that would be a flat line beside another one gets a plot of its own")
{
  const auto table = history({{"fluid.wall.velocity", {-1, 1}}, {"fluid.wall.sound_speed", {340, 341}}});

  const auto groups = group_curves(table, {{"fluid.wall.velocity", "m/s"}, {"fluid.wall.sound_speed", "m/s"}});

  REQUIRE(groups.size() == 2);
  CHECK(names(groups[0]) == Names{"fluid.wall.velocity"});
  CHECK(names(groups[1]) == Names{"fluid.wall.sound_speed"});
}

TEST_CASE("columns without a known unit share a plot with those of the same field")
{
  const auto table = history({{"a.wet.velocity_x", {0, 1}}, {"b.wall.velocity_x", {0, 1}}, {"a.wet.height", {0, 1}}});

  const auto groups = group_curves(table, {});

  REQUIRE(groups.size() == 2);
  CHECK(names(groups[0]) == Names{"a.wet.velocity_x", "b.wall.velocity_x"});
  CHECK(groups[0].unit == "");
}

TEST_CASE("ledger, driver, residuals, energies and other outputs have sections of their own")
{
  const auto table = history({{"driver.iterations", {2, 3}},
                              {"driver.inner.residual", {1e-3, 1e-9}},
                              {"work_fluid", {0, 5}},
                              {"impulse_fluid_x", {0, 5}},
                              {"fluid.volume.energy", {1e6, 1e6 + 4}},
                              {"structure.body.energy", {0, 4}},
                              {"fluid.volume.total_mass", {1, 1}}});

  const auto groups = group_curves(
      table,
      {{"fluid.volume.energy", "J"}, {"structure.body.energy", "J"}, {"work_fluid", "J"}, {"impulse_fluid_x", "N s"}});

  std::vector<Section> sections;
  for (const auto& group : groups) sections.push_back(group.section);
  CHECK(sections == std::vector{Section::outputs, Section::energies, Section::ledger, Section::ledger, Section::driver,
                                Section::residuals});
  CHECK(groups[1].columns.size() == 2); // as changes since the start both can be seen
}

TEST_CASE("a column without a finite number is in no plot")
{
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto table = history({{"a.b", {nan, nan}}, {"a.c", {nan, 2}}});

  const auto groups = group_curves(table, {});

  REQUIRE(groups.size() == 1);
  CHECK(names(groups[0]) == Names{"a.c"});
  CHECK(first_value(table.columns[3]) == 2);
}

TEST_CASE("no plot has more curves than can be told apart")
{
  std::vector<std::pair<std::string, std::vector<double>>> columns;
  for (int i = 0; i < 20; ++i) columns.push_back({"a.wet.velocity[" + std::to_string(i) + "]", {0, 1}});
  const auto table = history(columns);

  const auto groups = group_curves(table, {});

  REQUIRE(groups.size() == 2);
  CHECK(groups[0].columns.size() == 14);
  CHECK(groups[1].columns.size() == 6);
}

TEST_CASE("the quantity of a column is its field's name")
{
  CHECK(quantity_of("structure.wet.velocity") == "velocity");
  CHECK(quantity_of("structure.wet.velocity_x.max") == "velocity");
  CHECK(quantity_of("structure.wet.velocity[3]_y.mean") == "velocity");
  CHECK(quantity_of("fluid.wall.traction_mean") == "traction_mean");
  CHECK(quantity_of("energy") == "energy");
}

TEST_CASE("what ends with residual is one, whoever reports it, also as the largest of many")
{
  const auto section_of = [](const char* name) {
    const auto table = history({{name, {1e-3, 1e-9}}});
    return group_curves(table, {}).at(0).section;
  };

  for (const char* name : {"fluid.volume.solver_residual", "driver.inner.residual", "driver.fluid_residual",
                           "structure.body.residual.max"})
    CHECK_MESSAGE(section_of(name) == Section::residuals, name);
  CHECK(section_of("fluid.volume.residual_mass") == Section::outputs);
}
