// What a plot shows, as plain data, and its text in the language of gnuplot. Nothing here runs a program.
//
// Colours are those of Okabe and Ito, which the colour-blind can tell apart, without the yellow that is too pale for a
// line on white; dashes and point shapes differ too, so a print without colours can be read.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace mullion::report {

struct Axis {
  std::string label; ///< with its unit: "time [s]"
  bool is_log = false;
};

struct Curve {
  std::string title;
  std::vector<double> x, y; ///< as many; where one is not finite the curve is interrupted
  bool is_mark = false;     ///< points without a line between them, hollow
  int style = -1;           ///< colour, dash and point by number; negative: by its place among the plot's curves
};

enum class Shape {
  lines,  ///< y over x
  marked, ///< y over x, each point with a mark: few points
  dots,   ///< a row per label: y of a curve is the row, x the value
  bars    ///< a bar per label: y of a curve is the row; the curves' x are stacked
};

struct Plot {
  std::string name;    ///< of its files: letters, digits, - and _
  std::string title;   ///< above it on the page
  std::string caption; ///< below it on the page; may be empty
  Shape shape = Shape::lines;
  Axis x, y; ///< y is not used where there are labels
  std::vector<Curve> curves;
  std::vector<std::string> labels; ///< of dots and bars
};

/// At most so many curves can be told apart in one plot: seven colours, solid and dashed.
inline constexpr std::size_t max_curves = 14;

/// The letters, digits and - of a text; what lies between becomes one _.
[[nodiscard]] std::string file_name(const std::string& text);

/// A text as a constant of the script: in single quotes, within which gnuplot expands nothing; control characters
/// become spaces.
[[nodiscard]] std::string quote(const std::string& text);

/// A text with its middle left out, if it has more characters than `room`: the ends, with the unit, tell more.
[[nodiscard]] std::string shorten(const std::string& text, std::size_t room);

/// The curves' numbers: a block a curve, two empty lines between them. Bars are stacked here.
[[nodiscard]] std::string plot_data(const Plot& plot);

/// The commands that draw the plot twice, as `name`.svg and `name`.png, from the file `name`.dat.
[[nodiscard]] std::string plot_script(const Plot& plot);

/// "[low:high]" for an axis, a little wider than the values; wide enough to read if all are equal or there are none.
[[nodiscard]] std::string axis_range(const std::vector<double>& values, bool is_log, double margin);

/// The format of an axis' numbers: as many digits as tell its ends apart.
[[nodiscard]] std::string axis_format(const std::vector<double>& values);

} // namespace mullion::report
