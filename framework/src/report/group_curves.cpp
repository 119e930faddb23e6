#include "report/group_curves.hpp"

#include "report/plot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

namespace mullion::report {
namespace {

// A curve whose whole range is less than this part of the axis looks like a straight line.
constexpr double smallest_part = 0.05;

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;

  [[nodiscard]] double span() const { return high > low ? high - low : 0.0; }
};

/// What of the axis a column takes; energies are drawn as changes since the start.
Range range_of(const CsvColumn& column, Section section)
{
  const double offset = section == Section::energies ? first_value(column) : 0.0;
  Range range;
  for (const double value : column.numbers) {
    if (!std::isfinite(value - offset)) continue;
    range.low = std::min(range.low, value - offset);
    range.high = std::max(range.high, value - offset);
  }
  return range;
}

Range joined(const Range& a, const Range& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

/// A group while it grows, with what its members need to be seen.
struct Growing {
  CurveGroup group;
  std::string key;
  Range range;
  double smallest_span = std::numeric_limits<double>::infinity(); ///< of the members that vary
};

bool fits(const Growing& plot, const Range& range, double span)
{
  if (plot.group.columns.size() >= max_curves) return false;
  if (plot.group.section == Section::residuals) return true; // on a logarithmic axis orders of magnitude go together
  return std::min(plot.smallest_span, span) >= smallest_part * joined(plot.range, range).span();
}

/// What interfaces exchange, in the order of the report.
constexpr std::array exchanged = {"displacement", "velocity", "traction", "load"};

/// "structure.wet." of "structure.wet.velocity".
std::string window_of(const std::string& column) { return column.substr(0, column.rfind(quantity_of(column))); }

std::set<std::string> interface_windows(const CsvTable& history)
{
  std::set<std::string> windows;
  for (const auto& column : history.columns)
    if (std::find(exchanged.begin(), exchanged.end(), quantity_of(column.name)) != exchanged.end())
      windows.insert(window_of(column.name));
  return windows;
}

Section section_of(const std::string& column, const std::string& unit, const std::set<std::string>& interfaces)
{
  if (column.starts_with("work_") || column.starts_with("impulse_")) return Section::ledger;
  if (column.ends_with("residual") || column.ends_with("residual.max")) return Section::residuals;
  if (column.starts_with("driver.")) return Section::driver;
  if (unit == "J") return Section::energies;
  return interfaces.contains(window_of(column)) ? Section::interface : Section::outputs;
}

/// Where in its section a plot stands: that of the first quantity it has.
std::size_t rank(const CurveGroup& group)
{
  std::size_t first = exchanged.size();
  if (group.section != Section::interface) return first;
  for (const auto* column : group.columns) {
    const auto at = std::find(exchanged.begin(), exchanged.end(), quantity_of(column->name));
    first = std::min(first, static_cast<std::size_t>(at - exchanged.begin()));
  }
  return first;
}

} // namespace

bool has_values(const CsvColumn& column) { return !std::isnan(first_value(column)); }

double first_value(const CsvColumn& column)
{
  const auto found =
      std::find_if(column.numbers.begin(), column.numbers.end(), [](double value) { return std::isfinite(value); });
  return found == column.numbers.end() ? std::numeric_limits<double>::quiet_NaN() : *found;
}

std::string quantity_of(const std::string& column)
{
  auto name = column;
  for (const std::string statistic : {".mean", ".max", ".deviation"})
    if (name.ends_with(statistic)) name.resize(name.size() - statistic.size());
  if (const auto dot = name.rfind('.'); dot != std::string::npos) name.erase(0, dot + 1);
  if (const auto pane = name.find('['); pane != std::string::npos) name.erase(pane, name.find(']') + 1 - pane);
  const auto size = name.size();
  const bool is_component =
      size > 2 && name[size - 2] == '_' && std::string("xyz0123456789").find(name[size - 1]) != std::string::npos;
  if (is_component) name.resize(size - 2);
  return name;
}

std::vector<CurveGroup> group_curves(const CsvTable& history, const std::map<std::string, std::string>& units)
{
  const auto interfaces = interface_windows(history);
  std::vector<Growing> plots;
  for (const auto& column : history.columns) {
    if (column.is_text() || column.name == "step" || column.name == "time") continue;
    const auto known = units.find(column.name);
    const auto unit = known == units.end() ? std::string() : known->second;
    const auto section = section_of(column.name, unit, interfaces);
    const auto key = unit.empty() ? "of " + quantity_of(column.name) : unit;
    const auto range = range_of(column, section);
    if (!has_values(column)) continue;
    const double span = range.span() > 0.0 ? range.span() : std::numeric_limits<double>::infinity();
    auto at = std::find_if(plots.begin(), plots.end(), [&](const Growing& plot) {
      return plot.group.section == section && plot.key == key && fits(plot, range, span);
    });
    if (at == plots.end()) {
      auto& plot = plots.emplace_back();
      plot.group.section = section;
      plot.group.unit = unit;
      plot.key = key;
      at = plots.end() - 1;
    }
    at->group.columns.push_back(&column);
    at->range = joined(at->range, range);
    at->smallest_span = std::min(at->smallest_span, span);
  }
  std::stable_sort(plots.begin(), plots.end(), [](const Growing& a, const Growing& b) {
    return std::pair(a.group.section, rank(a.group)) < std::pair(b.group.section, rank(b.group));
  });
  std::vector<CurveGroup> groups;
  for (auto& plot : plots) groups.push_back(std::move(plot.group));
  return groups;
}

} // namespace mullion::report
