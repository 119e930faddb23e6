#include "report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace mullion::report {
namespace {

constexpr std::array colours = {"#0072B2", "#D55E00", "#009E73", "#000000", "#CC79A7", "#E69F00", "#56B4E9"};
// In units of the line's width, alternately drawn and left out. A second curve that hides the first would leave it
// visible between the dashes.
constexpr std::array dashes = {"solid", "(12,5)", "(4,3)", "(14,4,3,4)", "(22,6)", "(10,3,2,3,2,3)", "(2,4)"};
constexpr const char* waiting_colour = "#E69F00"; // of the second bar: much lighter than the first, in grey too
constexpr std::array full_points = {7, 5, 9, 13, 11, 15, 2};
constexpr std::array hollow_points = {6, 4, 8, 12, 10, 14, 1};

constexpr int width = 900;              // [px] of every plot
constexpr double largest_value = 1e300; // beyond it the margins of an axis would overflow

bool is_drawn(double value) { return std::isfinite(value) && std::abs(value) < largest_value; }

std::vector<double> drawn_values(const Plot& plot, std::vector<double> Curve::*coordinate, bool is_log)
{
  std::vector<double> values;
  for (const auto& curve : plot.curves)
    for (const double value : curve.*coordinate)
      if (is_drawn(value) && (!is_log || value > 0.0)) values.push_back(value);
  return values;
}

/// Where the longest stack of bars ends.
double longest_bar(const Plot& plot)
{
  std::vector<double> ends(plot.labels.size(), 0.0);
  for (const auto& curve : plot.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (is_drawn(curve.x[i])) ends[static_cast<std::size_t>(curve.y[i])] += curve.x[i];
  return ends.empty() ? 0.0 : *std::max_element(ends.begin(), ends.end());
}

bool has_labels(const Plot& plot) { return plot.shape == Shape::dots || plot.shape == Shape::bars; }

// How many characters find room.
constexpr std::size_t legend_room = 95, x_room = 80, y_room = 44, label_room = 45;

std::size_t longest_title(const Plot& plot)
{
  std::size_t longest = 1;
  for (const auto& curve : plot.curves) longest = std::max(longest, shorten(curve.title, legend_room).size());
  return longest;
}

bool has_legend(const Plot& plot) { return plot.curves.size() > 1; }

/// gnuplot gives a column of the legend about 8 px a character of its longest title and 90 px for the sample of the
/// line.
std::size_t legend_rows(const Plot& plot)
{
  const auto fitting = static_cast<std::size_t>(width - 20) / (8 * longest_title(plot) + 90);
  const auto n_columns = std::clamp<std::size_t>(fitting, 1, plot.curves.size());
  return (plot.curves.size() + n_columns - 1) / n_columns;
}

/// What stands below the axis, and the whole [px].
struct Heights {
  int below, whole;
};

Heights heights(const Plot& plot)
{
  const auto below = 60 + (has_legend(plot) ? 21 * legend_rows(plot) : 0); // 60: numbers and title of the axis
  const auto drawing = has_labels(plot) ? 36 * plot.labels.size() + 20 : 360;
  return {static_cast<int>(below), static_cast<int>(below + drawing)};
}

std::string style_of(const Plot& plot, std::size_t place)
{
  const auto& curve = plot.curves[place];
  const auto c = curve.style < 0 ? place : static_cast<std::size_t>(curve.style);
  const auto colour = colours[c % colours.size()];
  const auto dash = dashes[(c + c / colours.size()) % dashes.size()]; // another one when the colours come again
  const auto point = (curve.is_mark ? hollow_points : full_points)[c % full_points.size()];
  const auto marks = fmt::format("linecolor rgb '{}' pointtype {} pointsize 0.8", colour, point);
  if (plot.shape == Shape::bars)
    return fmt::format("with boxxyerror linecolor rgb '{}' fillstyle solid noborder",
                       c == 0 ? colours[0] : waiting_colour);
  if (plot.shape == Shape::dots || curve.is_mark) return "with points " + marks;
  return fmt::format("with {} linewidth 1.6 dashtype {} {}", plot.shape == Shape::marked ? "linespoints" : "lines",
                     dash, marks);
}

} // namespace

std::string file_name(const std::string& text)
{
  std::string name;
  for (const char c : text) {
    const bool is_kept = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-';
    if (is_kept) name += c;
    else if (!name.empty() && name.back() != '_') name += '_';
  }
  constexpr std::size_t at_most = 80; // file systems take 255 bytes
  name.resize(std::min(name.size(), at_most));
  while (name.ends_with('_')) name.pop_back();
  return name.empty() ? "plot" : name;
}

std::string quote(const std::string& text)
{
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') quoted += "''";
    else quoted += std::iscntrl(static_cast<unsigned char>(c)) != 0 ? ' ' : c;
  }
  return quoted + "'";
}

std::string shorten(const std::string& text, std::size_t room)
{
  if (text.size() <= room) return text;
  const auto is_within_character = [&](std::size_t i) { return (static_cast<unsigned char>(text[i]) & 0xC0) == 0x80; };
  auto head = room / 2, tail = text.size() - (room - room / 2);
  while (head > 0 && is_within_character(head)) --head;
  while (tail < text.size() && is_within_character(tail)) ++tail;
  return text.substr(0, head) + "…" + text.substr(tail);
}

std::string axis_range(const std::vector<double>& values, bool is_log, double margin)
{
  if (values.empty()) return is_log ? "[0.1:10]" : "[-1:1]";
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  double low = *lowest, high = *highest;
  if (is_log) {
    const double factor = high > 1.001 * low ? std::pow(high / low, margin) : 2.0;
    return fmt::format("[{}:{}]", low / factor, high * factor);
  }
  const double largest = std::max(std::abs(low), std::abs(high));
  const double span = high - low;
  // Equal, or so nearly that the numbers at the axis could not tell: a tenth around it, or one around zero.
  const double room = span > 1e-9 * largest ? margin * span : largest > 0.0 ? 0.1 * largest : 1.0;
  return fmt::format("[{}:{}]", low - room, high + room);
}

std::string axis_format(const std::vector<double>& values)
{
  constexpr int usual = 6; // digits, gnuplot's own choice
  if (values.empty()) return "%h";
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double largest = std::max(std::abs(*low), std::abs(*high));
  const double span = *high - *low;
  if (!(span > 1e-9 * largest)) return "%h";
  const int digits = static_cast<int>(std::ceil(std::log10(largest / span))) + 2; // ten ticks within the span
  return digits <= usual ? "%h" : fmt::format("%.{}g", digits);
}

std::string plot_data(const Plot& plot)
{
  std::string data;
  const auto number = [](double value) { return is_drawn(value) ? fmt::format("{}", value) : std::string("NaN"); };
  std::vector<double> begins(plot.labels.size(), 0.0);
  for (const auto& curve : plot.curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (plot.shape == Shape::bars) {
        // centre, row, left, right, bottom, top
        double& begin = begins[static_cast<std::size_t>(curve.y[i])];
        const double end = begin + (is_drawn(curve.x[i]) ? curve.x[i] : 0.0);
        data += fmt::format("{} {} {} {} {} {}\n", 0.5 * (begin + end), curve.y[i], begin, end, curve.y[i] - 0.35,
                            curve.y[i] + 0.35);
        begin = end;
      } else {
        data += number(curve.x[i]) + " " + number(curve.y[i]) + "\n";
      }
    }
    if (curve.x.empty()) data += "NaN NaN\n";
    data += "\n\n";
  }
  return data;
}

std::string plot_script(const Plot& plot)
{
  const auto file = [&](const char* ending) { return quote(plot.name + ending); };
  const auto x = drawn_values(plot, &Curve::x, plot.x.is_log);
  const auto y = drawn_values(plot, &Curve::y, plot.y.is_log);
  const bool is_time = plot.shape == Shape::lines;
  std::string script = "reset\nset encoding utf8\nset datafile missing 'NaN'\n";
  script += "set grid linecolor rgb '#dddddd' linetype 1 linewidth 0.5\nset border 3\nset tics nomirror\n";
  script += fmt::format("set xlabel {}\n", quote(shorten(plot.x.label, x_room)));
  if (plot.shape == Shape::bars) {
    const double longest = longest_bar(plot);
    script += fmt::format("set xrange [0:{}]\n", longest > 0.0 ? 1.05 * longest : 1.0);
  } else {
    script += fmt::format("set xrange {}\nset format x '{}'\n", axis_range(x, plot.x.is_log, is_time ? 0.0 : 0.05),
                          axis_format(x));
  }
  if (plot.x.is_log) script += "set logscale x\n";
  if (has_labels(plot)) {
    script += fmt::format("set yrange [{}:-0.6]\nset ytics (", static_cast<double>(plot.labels.size()) - 0.4);
    for (std::size_t i = 0; i < plot.labels.size(); ++i)
      script += fmt::format("{}{} {}", i == 0 ? "" : ", ", quote(shorten(plot.labels[i], label_room)), i);
    script += ") scale 0\n";
  } else {
    script += fmt::format("set yrange {}\nset format y '{}'\n", axis_range(y, plot.y.is_log, 0.06), axis_format(y));
    if (plot.y.is_log) script += "set logscale y\n";
  }
  if (!has_labels(plot)) script += fmt::format("set ylabel {}\n", quote(shorten(plot.y.label, y_room)));
  const auto [below, whole] = heights(plot);
  // Margins of our own: gnuplot's would let the legend run into the title of the axis. At the right there is room for
  // half of a number.
  script += fmt::format("set rmargin 5\nset tmargin 1\nset bmargin at screen {:.4f}\n",
                        static_cast<double>(below) / static_cast<double>(whole));
  if (has_legend(plot))
    script += fmt::format("set key at screen 0.01, screen 0.01 left bottom vertical Left reverse maxrows {}\n",
                          legend_rows(plot));
  else script += "unset key\n";

  std::string curves;
  for (std::size_t c = 0; c < plot.curves.size(); ++c)
    curves += fmt::format("{}{} index {} using {} {} title {}", c == 0 ? "plot " : ", \\\n     ", file(".dat"), c,
                          plot.shape == Shape::bars ? "1:2:3:4:5:6" : "1:2", style_of(plot, c),
                          quote(shorten(plot.curves[c].title, legend_room)));
  script += fmt::format(
      "set terminal svg noenhanced size {},{} font 'sans-serif,13' rounded background 'white'\nset output {}\n{}\n",
      width, whole, file(".svg"), curves);
  script += fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,10' rounded\nset output {}\n{}\n",
                        width, whole, file(".png"), curves);
  return script + "unset output\n";
}

} // namespace mullion::report
