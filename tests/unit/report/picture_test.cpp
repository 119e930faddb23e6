// Pictures as data and as text for gnuplot: every cell where it is, with its value; what cannot be drawn is left out.
#include "report/field_pictures.hpp"
#include "report/picture.hpp"

#include "report/gnuplot.hpp"
#include "report/html.hpp"

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace mullion::report;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// A square of 2 m with a triangle at its right.
Picture house()
{
  Picture picture;
  picture.name = "house";
  picture.label = "pressure [Pa]";
  picture.cells = {{{{{0, 0}, {2, 0}, {2, 2}, {0, 2}}}, 4, 1.5}, {{{{2, 0}, {3, 1}, {2, 2}}}, 3, -4.0}};
  return picture;
}

} // namespace

TEST_CASE("each cell of a picture is a closed polygon with its value, and the outline stands in a block of its own")
{
  auto picture = house();
  picture.outline = {{{{0, 0}, {3, 0}}}};

  CHECK(plot_data(picture) == "0 0 1.5\n2 0 1.5\n2 2 1.5\n0 2 1.5\n0 0 1.5\n\n"
                              "2 0 -4\n3 1 -4\n2 2 -4\n2 0 -4\n\n"
                              "\n0 0\n3 0\n\n");
}

TEST_CASE("the script of a picture has one scale for both axes, a range of colours and both formats")
{
  const auto script = plot_script(house());

  CHECK(has(script, "set size ratio -1\n"));
  CHECK(has(script, "set cbrange [-4:1.5]\n"));
  CHECK(has(script, "set cblabel 'pressure [Pa]'\n"));
  CHECK(has(script, "set output 'house.svg'\n"));
  CHECK(has(script, "set output 'house.png'\n"));
  // 3 m by 2 m, with 3 % of the longer side around: 3.18 m over 770 px make 2.18 m 528 px; 183 px are around them
  CHECK(has(script, "size 900,711 "));
}

TEST_CASE("cells that are not finite, in place or value, are left out of picture and range")
{
  auto picture = house();
  auto nowhere = picture.cells[0], nothing = picture.cells[0];
  nowhere.corners[3].y = std::numeric_limits<double>::quiet_NaN();
  nowhere.value = 100.0;
  nothing.value = std::numeric_limits<double>::infinity();
  const auto data = plot_data(picture);
  picture.cells.push_back(nowhere);
  picture.cells.push_back(nothing);

  CHECK(plot_data(picture) == data);
  CHECK(has(plot_script(picture), "set cbrange [-4:1.5]\n"));
}

TEST_CASE("a picture of very many cells is drawn as PNG alone")
{
  auto picture = house();
  picture.cells.resize(max_svg_cells, picture.cells[0]);
  CHECK(has(plot_script(picture), "house.svg"));

  picture.cells.push_back(picture.cells[0]);

  CHECK_FALSE(has(plot_script(picture), "house.svg"));
  CHECK(has(plot_script(picture), "house.png"));
  CHECK_FALSE(has(figure_html(picture, {"", "png"}), "house.svg"));
}

TEST_CASE("gnuplot fills each cell with the colour of its value")
{
  auto picture = house();
  picture.cells[1].value = 7.0;

  const auto drawings = draw({picture});

  REQUIRE(drawings.size() == 1);
  CHECK(drawings[0].png.starts_with("\x89PNG"));
  CHECK(has(drawings[0].svg, "shape-rendering: crispEdges"));
  CHECK(has(drawings[0].svg, "fill = 'rgb( 68,   1,  84)'")); // #440154: the lowest value
  CHECK(has(drawings[0].svg, "fill = 'rgb(253, 231,  37)'")); // #fde725: the highest
}

TEST_CASE("one value everywhere, flat cells and cells of no size are drawn too")
{
  auto uniform = house();
  uniform.cells[1].value = uniform.cells[0].value;
  auto flat = house();
  flat.name = "flat";
  for (auto& cell : flat.cells)
    for (auto& corner : cell.corners) corner.y = 5.0;
  auto point = house();
  point.name = "point";
  for (auto& cell : point.cells) cell.corners = {};

  const auto drawings = draw({uniform, flat, point});

  for (const auto& drawing : drawings) CHECK(drawing.png.starts_with("\x89PNG"));
}

TEST_CASE("a picture on the page is its PNG in base 64, with an escaped title")
{
  auto picture = house();
  picture.title = "<script>";

  const auto html = figure_html(picture, {"<svg></svg>", "foobar"});

  CHECK(has(html, "src=\"data:image/png;base64,Zm9vYmFy\""));
  CHECK(has(html, "&lt;script&gt;"));
  CHECK_FALSE(has(html, "<script>"));
  CHECK(has(html, "\"plots/house.svg\""));
  CHECK(has(html, "\"plots/house.png\""));
}

TEST_CASE("base 64 is that of RFC 4648, section 10")
{
  CHECK(base64("") == "");
  CHECK(base64("f") == "Zg==");
  CHECK(base64("fo") == "Zm8=");
  CHECK(base64("foo") == "Zm9v");
  CHECK(base64("foob") == "Zm9vYg==");
  CHECK(base64("\xff\xff\xfe") == "///+"); // bytes beyond 127
}

TEST_CASE("a displacement is magnified by a round number, to a tenth of the mesh at most")
{
  CHECK(magnification(0.001, 1.0) == 100.0);
  CHECK(magnification(0.0011, 1.0) == 50.0);
  CHECK(magnification(0.019, 1.0) == 5.0);
  CHECK(magnification(0.003, 2.0) == 50.0);
  CHECK(magnification(1e-6, 1.0) == doctest::Approx(1e5));
}
