// A field over the cells of a plane mesh as a picture: plain data, and its text in the language of gnuplot. Nothing
// here runs a program. A cell has one value and one colour, without smoothing: what is seen is what was computed.
//
// The colours are those of viridis: they get lighter evenly, so a print without colours can be read too.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace mullion::report {

struct Point {
  double x = 0.0, y = 0.0; ///< [m]
};

/// A triangle or a quadrilateral where it is drawn.
struct Cell {
  std::array<Point, 4> corners{};
  std::size_t n_corners = 0;
  double value = 0.0;
};

/// A line from a point to another one.
using Segment = std::array<Point, 2>;

struct Picture {
  std::string name;    ///< of its files: letters, digits, - and _
  std::string title;   ///< above it on the page
  std::string caption; ///< below it on the page; may be empty
  std::string label;   ///< of the colour bar, with the unit: "pressure [Pa]"
  std::vector<Cell> cells;
  std::vector<Segment> outline; ///< orange over the cells, or none: the boundary of the undeformed mesh
};

/// Pictures of more cells have no SVG: it would take a browser longer to show than most readers wait.
inline constexpr std::size_t max_svg_cells = 50000;

/// Whether it can be drawn: its corners and its value are finite, and small enough for gnuplot's axes.
[[nodiscard]] bool is_drawn(const Cell& cell);

/// The cells that are drawn: a closed polygon each, a line "x y value" a corner, an empty line behind it. Two empty
/// lines, then the outline's lines in the same manner.
[[nodiscard]] std::string plot_data(const Picture& picture);

/// The commands that draw the picture as `name`.png and, up to max_svg_cells, `name`.svg, from the file `name`.dat;
/// lengths along x and y have the same scale.
/// @pre at least one cell is drawn
[[nodiscard]] std::string plot_script(const Picture& picture);

} // namespace mullion::report
