// Which pictures a run's results give: windows in a plane with areas, a few fields each, where the mesh lies.
#include "report/field_pictures.hpp"

#include "io/results_writer.hpp"
#include "report/plane_mesh.hpp"

#include "../io/scratch.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::report;
using mullion::testing::Scratch;
using mullion::testing::SmallRun;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// Two unit squares, the right one as two triangles behind a line; element 2 is the line.
struct TwoSquares {
  std::vector<double> xy{0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 1};
  std::vector<std::int32_t> square{0, 1, 4, 3}, line{0, 1}, triangles{1, 2, 5, 1, 5, 4};

  [[nodiscard]] io::WindowData window() const
  {
    return {"fluid/volume",
            {{0,
              2,
              6,
              4,
              xy.data(),
              {{MULLION_QUADRILATERAL4, 4, 1, square.data()},
               {MULLION_LINE2, 2, 1, line.data()},
               {MULLION_TRIANGLE3, 3, 2, triangles.data()}},
              {}}}};
  }
};

io::FieldData field(const std::string& name, const std::string& unit, std::uint32_t location, std::int64_t components,
                    const std::vector<double>& values)
{
  return {name,          unit,   {}, location, components, static_cast<std::int64_t>(values.size()) / components,
          values.data(), nullptr};
}

/// The section of a run whose last output has these fields on the two squares.
Page section(const std::vector<io::FieldData>& fields)
{
  const Scratch folder;
  const TwoSquares mesh;
  auto window = mesh.window();
  io::ResultsWriter writer(folder.path(), "run");
  writer.begin({window});
  writer.write(0, 0.0, {window}); // without fields: the last output is what counts
  window.panes[0].fields = fields;
  writer.write(7, 0.5, {window});
  writer.finish();
  Page page;
  add_field_pictures(page, folder.path());
  return page;
}

std::vector<Picture> pictures(const Page& page)
{
  std::vector<Picture> found;
  for (const auto& piece : page.pieces)
    if (const auto* figure = std::get_if<Figure>(&piece)) found.push_back(std::get<Picture>(*figure));
  return found;
}

std::string texts(const Page& page)
{
  std::string all;
  for (const auto& piece : page.pieces)
    if (const auto* html = std::get_if<Html>(&piece)) all += html->text;
  return all;
}

} // namespace

TEST_CASE("a field on elements is drawn on their triangles and quadrilaterals where coordinates say they are")
{
  const std::vector<double> coordinates{0, 0, 1, 0, 2.5, 0, 0, 1, 1, 1, 2.5, 1};
  const std::vector<double> pressure{10, 20, 30, 40};

  const auto page = section(
      {field("coordinates", "m", MULLION_NODE, 2, coordinates), field("pressure", "Pa", MULLION_ELEMENT, 1, pressure)});

  const auto drawn = pictures(page);
  REQUIRE(drawn.size() == 2); // the pressure and the displacement, which is large enough to be seen
  CHECK(drawn[0].name == "fluid_volume-pressure");
  CHECK(drawn[0].title == "fluid.volume: pressure at t = 0.5 s");
  CHECK(drawn[0].label == "pressure [Pa]");
  CHECK(plot_data(drawn[0]) == "0 0 10\n1 0 10\n1 1 10\n0 1 10\n0 0 10\n\n" // 20 is the line's
                               "1 0 30\n2.5 0 30\n2.5 1 30\n1 0 30\n\n"
                               "1 0 40\n2.5 1 40\n1 1 40\n1 0 40\n\n");
  CHECK(has(texts(page), "step 7, t = 0.5 s"));
}

TEST_CASE("the displacement is drawn over the boundary before it moved, of each cell the mean of its nodes")
{
  const std::vector<double> displacement{0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0, 0.5, 0};

  const auto drawn = pictures(section({field("displacement", "m", MULLION_NODE, 2, displacement)}));

  REQUIRE(drawn.size() == 1);
  CHECK(drawn[0].label == "displacement [m]");
  REQUIRE(drawn[0].cells.size() == 3);
  CHECK(drawn[0].cells[0].value == 0.0);
  CHECK(drawn[0].cells[1].value == doctest::Approx(1.0 / 3.0)); // round-off: two nodes of three moved 0.5 m
  CHECK(drawn[0].cells[1].corners[1].x == 2.5);
  CHECK(drawn[0].outline.size() == 6); // of the rectangle; the edges 1-4 and 1-5 are within
}

TEST_CASE("a displacement too small to be seen has a second picture with a magnified one")
{
  std::vector<double> displacement(12, 0.0);
  displacement[4] = 0.0009765625; // of 2 m: exact in binary, as are 100 times it

  const auto drawn = pictures(section({field("displacement", "m", MULLION_NODE, 2, displacement)}));

  REQUIRE(drawn.size() == 2);
  CHECK(drawn[0].cells[1].corners[1].x == 2.0009765625);
  CHECK(has(drawn[1].title, "drawn 200 times as large"));
  CHECK(drawn[1].cells[1].corners[1].x == 2.1953125);
  CHECK(drawn[1].cells[1].value == drawn[0].cells[1].value); // the colours tell the true one
}

TEST_CASE("a mesh that does not move, but for round-off, has no picture of its displacement")
{
  std::vector<double> displacement(12, 0.0);
  displacement[4] = 1e-15;

  CHECK(pictures(section({field("displacement", "m", MULLION_NODE, 2, displacement)})).empty());
}

TEST_CASE("a position is taken for where the nodes are if there are no coordinates")
{
  std::vector<double> position{0, 0, 1, 0, 2, 0, 0, 1, 1, 1, 2, 3};
  const std::vector<double> pressure{10, 20, 30, 40};

  const auto drawn = pictures(section(
      {field("position", "m", MULLION_NODE, 2, position), field("pressure", "Pa", MULLION_ELEMENT, 1, pressure)}));

  REQUIRE(drawn.size() == 2);
  CHECK(drawn[0].cells[1].corners[2].y == 3.0);
}

TEST_CASE("pressures come first, then speeds, dimensionless numbers, other scalars; more than four fields are named "
          "and not drawn")
{
  const std::vector<double> on_elements{1, 2, 3, 4}, on_nodes{1, 2, 3, 4, 5, 7};
  const std::vector<double> velocity{3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, stress(12, 1.0);
  const std::vector<std::int32_t> part{1, 2, 3, 4};
  io::FieldData integers{"part", "1", {}, MULLION_ELEMENT, 1, 4, nullptr, part.data()};

  const auto page =
      section({field("density", "kg/m^3", MULLION_ELEMENT, 1, on_elements),
               field("mach", "1", MULLION_ELEMENT, 1, on_elements), field("velocity", "m/s", MULLION_NODE, 2, velocity),
               field("stress", "Pa", MULLION_ELEMENT, 3, stress), // neither scalar nor velocity
               field("head", "Pa", MULLION_NODE, 1, on_nodes), field("pressure", "Pa", MULLION_ELEMENT, 1, on_elements),
               integers});

  std::vector<std::string> names;
  const auto drawn = pictures(page);
  for (const auto& picture : drawn) names.push_back(picture.name);
  CHECK(names == std::vector<std::string>{"fluid_volume-pressure", "fluid_volume-head", "fluid_volume-velocity",
                                          "fluid_volume-mach"});
  CHECK(has(texts(page), "more fields, which results.xdmf shows: density</p>"));
  REQUIRE(drawn.size() == 4);
  CHECK(drawn[1].cells[0].value == 3.0);  // nodes 0, 1, 4, 3: (1 + 2 + 5 + 4) / 4
  CHECK(drawn[2].cells[0].value == 1.25); // node 0 of four has |(3, 4)| = 5
  CHECK(drawn[2].label == "magnitude of velocity [m/s]");
}

TEST_CASE("values that are not finite are left out and counted, and a field of nothing else has a sentence")
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> holes{10, 20, none, 40}, nothing(4, none);

  const auto page =
      section({field("holes", "Pa", MULLION_ELEMENT, 1, holes), field("nothing", "Pa", MULLION_ELEMENT, 1, nothing)});

  const auto drawn = pictures(page);
  REQUIRE(drawn.size() == 1);
  CHECK(drawn[0].caption == "1 cell is not finite and left out.");
  CHECK(has(texts(page), "fluid.volume: nothing at t = 0.5 s: no value is finite, so there is no picture."));
}

TEST_CASE("of all windows those in a plane with areas are drawn")
{
  const Scratch folder;
  const SmallRun run;
  io::ResultsWriter writer(folder.path(), "run");
  writer.begin(run.mesh());
  writer.write(0, 0.0, run.fields());
  writer.finish();
  Page page;

  add_field_pictures(page, folder.path());

  const auto drawn = pictures(page); // no scalar, but a displacement of 1 m
  REQUIRE(drawn.size() == 1);
  CHECK(drawn[0].name == "structure_plate-displacement");
  CHECK(drawn[0].cells.size() == 2);
}

TEST_CASE("a run without results adds nothing, and one whose output is gone a sentence")
{
  const Scratch folder;
  Page page;
  add_field_pictures(page, folder.path());
  CHECK(page.pieces.empty());

  const TwoSquares mesh;
  {
    io::ResultsWriter writer(folder.path(), "run");
    writer.begin({mesh.window()});
    writer.write(3, 0.0, {mesh.window()});
    writer.finish();
  }
  std::filesystem::remove(folder / "results/000000003.h5");
  add_field_pictures(page, folder.path());

  CHECK(has(texts(page), "There is no 000000003.h5 in results/, though results.h5 names it."));
}
