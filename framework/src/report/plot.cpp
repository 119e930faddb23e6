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

/// Where the stacked bars begin and end.
std::vector<double> bar_ends(const Plot& plot)
{
  std::vector<double> ends(plot.labels.size() + 1, 0.0); // the last: where all begin
  for (const auto& curve : plot.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (is_drawn(curve.x[i])) ends[static_cast<std::size_t>(curve.y[i])] += curve.x[i];
  return ends;
}

bool has_labels(const Plot& plot) { return plot.shape == Shape::dots || plot.shape == Shape::bars; }

std::size_t longest_title(const Plot& plot)
{
  std::size_t longest = 1;
  for (const auto& curve : plot.curves) longest = std::max(longest, curve.title.size());
  return longest;
}

/// Titles are 7 px a character, as in most fonts of that size, and 60 px for the sample of the line.
std::size_t legend_columns(const Plot& plot)
{
  const auto fitting = static_cast<std::size_t>(width - 60) / (7 * longest_title(plot) + 60);
  return std::clamp<std::size_t>(fitting, 1, plot.curves.size());
}

int height(const Plot& plot)
{
  const auto n_curves = std::max<std::size_t>(1, plot.curves.size());
  const auto legend_rows = n_curves < 2 ? 1 : (n_curves + legend_columns(plot) - 1) / legend_columns(plot);
  const auto drawing = has_labels(plot) ? 30 * plot.labels.size() + 70 : 360;
  return static_cast<int>(drawing + 20 * legend_rows + 40);
}

std::string style_of(const Plot& plot, std::size_t c)
{
  const auto colour = colours[c % colours.size()];
  const auto dash = dashes[(c + c / colours.size()) % dashes.size()]; // another one when the colours come again
  const auto point = (plot.curves[c].is_mark ? hollow_points : full_points)[c % full_points.size()];
  const auto marks = fmt::format("linecolor rgb '{}' pointtype {} pointsize 0.8", colour, point);
  if (plot.shape == Shape::bars)
    return fmt::format("with boxxyerror linecolor rgb '{}' fillstyle {} border", colour,
                       c == 0 ? "solid 0.9" : "pattern 4");
  if (plot.shape == Shape::dots || plot.curves[c].is_mark) return "with points " + marks;
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
  auto x = plot.shape == Shape::bars ? bar_ends(plot) : drawn_values(plot, &Curve::x, plot.x.is_log);
  const auto y = drawn_values(plot, &Curve::y, plot.y.is_log);
  const bool is_time = plot.shape == Shape::lines;
  std::string script = "reset\nset encoding utf8\nset datafile missing 'NaN'\n";
  script += "set grid linecolor rgb '#dddddd' linetype 1 linewidth 0.5\nset border 3\nset tics nomirror\n";
  script += fmt::format("set xlabel {}\nset xrange {}\nset format x '{}'\n", quote(plot.x.label),
                        axis_range(x, plot.x.is_log, is_time ? 0.0 : 0.05), axis_format(x));
  if (plot.x.is_log) script += "set logscale x\n";
  if (has_labels(plot)) {
    script += fmt::format("set yrange [{}:-0.6]\nset ytics (", static_cast<double>(plot.labels.size()) - 0.4);
    for (std::size_t i = 0; i < plot.labels.size(); ++i)
      script += fmt::format("{}{} {}", i == 0 ? "" : ", ", quote(plot.labels[i]), i);
    script += ")\n";
  } else {
    script += fmt::format("set yrange {}\nset format y '{}'\n", axis_range(y, plot.y.is_log, 0.06), axis_format(y));
    if (plot.y.is_log) script += "set logscale y\n";
  }
  if (!plot.y.label.empty()) script += fmt::format("set ylabel {}\n", quote(plot.y.label));
  script += "set rmargin 5\nset tmargin 1\n"; // room for half of a number at the ends of the axes
  const bool is_named = plot.curves.size() > 1 || has_labels(plot);
  if (is_named) script += fmt::format("set key below left Left reverse maxcols {}\n", legend_columns(plot));
  else script += "unset key\n";

  std::string curves;
  for (std::size_t c = 0; c < plot.curves.size(); ++c)
    curves +=
        fmt::format("{}{} index {} using {} {} title {}", c == 0 ? "plot " : ", \\\n     ", file(".dat"), c,
                    plot.shape == Shape::bars ? "1:2:3:4:5:6" : "1:2", style_of(plot, c), quote(plot.curves[c].title));
  script += fmt::format("set terminal svg noenhanced size {},{} font 'sans-serif,13' rounded\nset output {}\n{}\n",
                        width, height(plot), file(".svg"), curves);
  script += fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,10' rounded\nset output {}\n{}\n",
                        width, height(plot), file(".png"), curves);
  return script + "unset output\n";
}

} // namespace mullion::report
