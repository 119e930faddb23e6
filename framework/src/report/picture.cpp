#include "report/picture.hpp"

#include "report/plot.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mullion::report {
namespace {

// [px] of the whole, and of what stands around the drawing: numbers and titles of the axes, the colour bar below
constexpr double width = 900, left = 85, right = 45, top = 15, below_axis = 76, bar_height = 16, below_bar = 76;
constexpr double smallest_side = 60, largest_height = 700; // [px] of the drawing
constexpr double largest_value = 1e300;                    // beyond it the margins of an axis would overflow

constexpr const char* viridis = "0 '#440154', 1 '#472d7b', 2 '#3b528b', 3 '#2c728e', 4 '#21918c', 5 '#28ae80', "
                                "6 '#5ec962', 7 '#addc30', 8 '#fde725'";

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  void add(double value)
  {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double span() const { return high - low; }
};

struct Box {
  Range x, y;

  void add(const Point& point)
  {
    x.add(point.x);
    y.add(point.y);
  }
};

/// What is to be seen, a little wider; never of no width or height.
Box view(const Picture& picture)
{
  Box box;
  for (const auto& cell : picture.cells) {
    if (!is_drawn(cell)) continue;
    for (std::size_t c = 0; c < cell.n_corners; ++c) box.add(cell.corners[c]);
  }
  for (const auto& segment : picture.outline)
    for (const auto& end : segment) box.add(end);
  const double largest = std::max(box.x.span(), box.y.span());
  const double room = largest > 0.0 ? 0.03 * largest : 1.0; // cells of no size: any view is as good
  for (auto* range : {&box.x, &box.y}) {
    range->low -= room;
    range->high += room;
  }
  return box;
}

/// How large the box is drawn [px across, px down].
std::pair<double, double> size_of(const Box& box)
{
  const double room = width - left - right, ratio = box.y.span() / box.x.span();
  const double down = std::clamp(room * ratio, smallest_side, largest_height);
  return {std::clamp(down / ratio, smallest_side, room), down};
}

/// The distance between numbers at an axis: 1, 2 or 5 times a power of ten, such that at most `n` of them, or two, fit.
double tick_step(double span, double n)
{
  const double wanted = span / std::max(n, 2.0);
  const double decade = std::pow(10.0, std::floor(std::log10(wanted)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * decade >= wanted) return digit * decade;
  return 10.0 * decade;
}

bool is_finite(const Point& point)
{
  return std::isfinite(point.x) && std::isfinite(point.y) && std::abs(point.x) < largest_value &&
         std::abs(point.y) < largest_value;
}

} // namespace

bool is_drawn(const Cell& cell)
{
  return std::isfinite(cell.value) && std::abs(cell.value) < largest_value &&
         std::all_of(cell.corners.begin(), cell.corners.begin() + static_cast<long>(cell.n_corners), is_finite);
}

std::string plot_data(const Picture& picture)
{
  std::string data;
  const auto out = std::back_inserter(data);
  for (const auto& cell : picture.cells) {
    if (!is_drawn(cell)) continue;
    for (std::size_t c = 0; c <= cell.n_corners; ++c) {
      const auto& corner = cell.corners[c % cell.n_corners];
      fmt::format_to(out, "{} {} {}\n", corner.x, corner.y, cell.value);
    }
    data += '\n';
  }
  if (picture.outline.empty()) return data;
  data += '\n';
  for (const auto& [a, b] : picture.outline) fmt::format_to(out, "{} {}\n{} {}\n\n", a.x, a.y, b.x, b.y);
  return data;
}

std::string plot_script(const Picture& picture)
{
  std::vector<double> values;
  for (const auto& cell : picture.cells)
    if (is_drawn(cell)) values.push_back(cell.value);
  MULLION_ASSERT(!values.empty(), "picture {} has no cell that can be drawn", picture.name);
  const auto file = [&](const char* ending) { return quote(picture.name + ending); };
  const auto box = view(picture);
  const auto [across, down] = size_of(box);
  const double whole = std::round(top + down + below_axis + bar_height + below_bar);

  std::string script = "reset\nset encoding utf8\nunset key\nset border 3\nset tics nomirror out\n";
  script += fmt::format("set palette defined ({})\nset style fill solid noborder\n", viridis);
  script += fmt::format("set xlabel 'x [m]'\nset ylabel 'y [m]'\nset xrange [{}:{}]\nset yrange [{}:{}]\n", box.x.low,
                        box.x.high, box.y.low, box.y.high);
  script += fmt::format("set xtics {}\nset ytics {}\n", tick_step(box.x.span(), across / 90), // [px] a number needs
                        tick_step(box.y.span(), down / 45));
  const double begin = left + 0.5 * (width - left - right - across); // in the middle, if it is narrow
  script += fmt::format("set lmargin at screen {:.4f}\nset rmargin at screen {:.4f}\n", begin / width,
                        (begin + across) / width);
  script += fmt::format("set tmargin at screen {:.4f}\nset bmargin at screen {:.4f}\nset size ratio -1\n",
                        1.0 - top / whole, (below_bar + bar_height + below_axis) / whole);
  script += fmt::format("set cbrange {}\nset format cb '{}'\nset cblabel {}\n", axis_range(values, false, 0.0),
                        axis_format(values), quote(shorten(picture.label, 80)));
  const auto [lowest, highest] = std::minmax_element(values.begin(), values.end());
  const double span = *highest - *lowest; // if it is next to nothing, axis_range() has chosen another one
  if (span > 1e-9 * std::max(std::abs(*lowest), std::abs(*highest)))
    script += fmt::format("set cbtics {}\n", tick_step(span, 8)); // so many numbers fit, long ones too
  script += fmt::format("set colorbox horizontal user origin screen {:.4f}, screen {:.4f} size screen {:.4f}, "
                        "screen {:.4f}\n",
                        left / width, below_bar / whole, 1.0 - (left + right) / width, bar_height / whole);
  auto plot = fmt::format("plot {} index 0 using 1:2:3 with polygons fillcolor palette", file(".dat"));
  if (!picture.outline.empty())
    plot +=
        fmt::format(", \\\n     {} index 1 using 1:2 with lines linecolor rgb '#D55E00' linewidth 1.2", file(".dat"));
  if (values.size() <= max_svg_cells)
    script += fmt::format("set terminal svg noenhanced size {},{} font 'sans-serif,13' rounded background 'white'\n"
                          "set output {}\n{}\n",
                          width, whole, file(".svg"), plot);
  script += fmt::format("set terminal pngcairo noenhanced size {},{} font 'sans,10' rounded\nset output {}\n{}\n",
                        width, whole, file(".png"), plot);
  return script + "unset output\n";
}

} // namespace mullion::report
