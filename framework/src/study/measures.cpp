#include "study/measures.hpp"

#include "run/signal.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace mullion::study {
namespace {

using Values = std::vector<std::optional<double>>;

/// Times are computed from a start and a step: borders of windows are met to this part of a step.
constexpr double rounding = 1e-6;

double mean_step(std::span<const double> times)
{
  return times.size() < 2 ? 0.0 : (times.back() - times.front()) / static_cast<double>(times.size() - 1);
}

double mean(std::span<const double> values)
{
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double largest_magnitude(std::span<const double> values)
{
  double largest = 0.0;
  for (const double v : values) largest = std::max(largest, std::abs(v));
  return largest;
}

void check_window(std::span<const double> times, double window)
{
  const double length = times.empty() ? 0.0 : times.back() - times.front();
  MULLION_REQUIRE(times.size() >= 2 && length + rounding * mean_step(times) >= window, Errc::shape,
                  "the record of {} s is shorter than the window of {} s", length, window);
}

/// How many samples from the first lie within `length` of it.
std::size_t n_within(std::span<const double> times, double length)
{
  const double end = times.front() + length + rounding * mean_step(times);
  return static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), end) - times.begin());
}

/// Sums from the first sample on, so that the deviation of any window costs two differences. In extended precision
/// and about a value near the first samples: what is small at the begin must not drown in what comes later.
class RunningDeviation {
public:
  /// @param offset  deviations are from it; none: from each window's mean
  /// @param about   a value near those of the first windows
  RunningDeviation(std::span<const double> values, std::optional<double> offset, double about)
      : is_about_offset_(offset.has_value()), sums_(values.size() + 1, 0.0L), squares_(values.size() + 1, 0.0L)
  {
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto q = static_cast<long double>(values[i]) - offset.value_or(about);
      sums_[i + 1] = sums_[i] + q;
      squares_[i + 1] = squares_[i] + q * q;
    }
  }
  /// Of the samples [begin, end).
  [[nodiscard]] double over(std::size_t begin, std::size_t end) const
  {
    const auto n = static_cast<long double>(end - begin);
    const long double average = is_about_offset_ ? 0.0L : (sums_[end] - sums_[begin]) / n;
    return static_cast<double>(std::sqrt(std::max(0.0L, (squares_[end] - squares_[begin]) / n - average * average)));
  }

private:
  bool is_about_offset_;
  std::vector<long double> sums_, squares_;
};

// ---- from a history ----------------------------------------------------------------------------------------------

/// The rows that a measure looks at.
struct Rows {
  std::size_t begin = 0, end = 0;
  std::span<const double> times;
};

std::span<const double> part_of(const std::vector<double>& column, const Rows& rows)
{
  return std::span(column).subspan(rows.begin, rows.end - rows.begin);
}

Rows rows_of(const Measure& measure, const ColumnTable& history)
{
  const auto& times = history.column("time");
  for (std::size_t i = 1; i < times.size(); ++i)
    MULLION_REQUIRE(times[i] > times[i - 1], Errc::numeric, "the times do not increase: {} after {}", times[i],
                    times[i - 1]);
  const double close = rounding * mean_step(times);
  Rows rows;
  rows.begin =
      static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), measure.from - close) - times.begin());
  rows.end = static_cast<std::size_t>(std::upper_bound(times.begin(), times.end(), measure.to + close) - times.begin());
  MULLION_REQUIRE(rows.begin < rows.end, Errc::shape, "there are no rows from {} s to {} s; {}", measure.from,
                  measure.to,
                  times.empty() ? "the history is empty"
                                : fmt::format("the history goes from {} s to {} s", times.front(), times.back()));
  rows.times = part_of(times, rows);
  return rows;
}

std::span<const double> quantity(const ColumnTable& history, const std::string& name, const Rows& rows)
{
  const auto values = part_of(history.column(name), rows);
  for (std::size_t i = 0; i < values.size(); ++i)
    MULLION_REQUIRE(std::isfinite(values[i]), Errc::numeric, "'{}' is {} at {} s", name, values[i], rows.times[i]);
  return values;
}

Values growth(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  const double frequency = run::dominant_frequency(times, values);
  const auto fit = run::growth_rate(times, values, frequency);
  if (fit.relative_residual >= 1.0) return {std::nullopt, std::nullopt, std::nullopt}; // nothing oscillates
  return {fit.sigma * m.scale, fit.relative_residual, fit.frequency};
}

Values doubling(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  const auto found = error_doubling(times, values, m.window, m.offset);
  const auto scaled = [&](const std::optional<double>& x) { return x ? std::optional(*x * m.scale) : std::nullopt; };
  return {scaled(found.rate), scaled(found.bound)};
}

Values frequency(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  const double found = run::dominant_frequency(times, values);
  if (found <= 0.0) return {std::nullopt};
  return {found * m.scale};
}

Values two_frequencies(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  const auto peaks = run::spectral_peaks(times, values, 2);
  if (peaks.empty()) return {std::nullopt, std::nullopt, std::nullopt};
  if (peaks.size() == 1) return {peaks[0].frequency * m.scale, std::nullopt, std::nullopt};
  return {peaks[0].frequency * m.scale, peaks[1].frequency * m.scale, peaks[1].height};
}

/// An answer that the run recorded.
Values function(const Measure& m, const RunFacts& facts)
{
  for (const auto& [call, answer] : facts.functions)
    if (call == m.quantity) return {answer * m.scale};
  std::string asked;
  for (const auto& entry : facts.functions) asked += (asked.empty() ? "" : ", ") + entry.first;
  throw Error(Errc::config, fmt::format("the run was not asked for '{}'; [output] functions of the case asks for {}",
                                        m.quantity, asked.empty() ? "nothing" : asked));
}

Values first_time(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  for (std::size_t i = 0; i < values.size(); ++i)
    if (std::abs(values[i]) > m.above) return {times[i] * m.scale};
  return {std::nullopt};
}

Values reference_error(const Measure& m, std::span<const double> times, std::span<const double> values)
{
  const double close = rounding * mean_step(times);
  double largest = 0.0, square = 0.0;
  std::size_t n = 0;
  for (std::size_t r = 0; r < m.reference_times.size(); ++r) {
    const double t = m.reference_times[r];
    if (t < times.front() - close || t > times.back() + close) continue; // a reference may be longer than the run
    const auto upper = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t) - times.begin());
    const std::size_t right = std::min(std::max<std::size_t>(upper, 1), times.size() - 1);
    const std::size_t left = right == 0 ? 0 : right - 1;
    const double xi = left == right ? 0.0 : std::clamp((t - times[left]) / (times[right] - times[left]), 0.0, 1.0);
    const double error = std::abs((1.0 - xi) * values[left] + xi * values[right] - m.reference_values[r]);
    largest = std::max(largest, error);
    square += error * error;
    ++n;
  }
  MULLION_REQUIRE(n > 0, Errc::shape, "no time of the reference lies between {} s and {} s; is time_scale right?",
                  times.front(), times.back());
  return {(m.norm == "rms" ? std::sqrt(square / static_cast<double>(n)) : largest) / m.scale};
}

Values drift(const Measure& m, const ColumnTable& history, const Rows& rows)
{
  std::vector<double> energy(rows.times.size(), 0.0);
  for (const auto& [name, coefficient] : m.terms) {
    const auto values = quantity(history, name, rows);
    for (std::size_t i = 0; i < values.size(); ++i) energy[i] += coefficient * values[i];
  }
  double largest = 0.0;
  for (const double e : energy) largest = std::max(largest, std::abs(e - energy.front()));
  if (m.relative_to.empty()) return {largest * m.scale};
  const double size = largest_magnitude(quantity(history, m.relative_to, rows));
  MULLION_REQUIRE(size > 0.0, Errc::numeric, "'{}', which the drift is relative to, is 0 throughout", m.relative_to);
  return {largest / size * m.scale};
}

/// The initial state (step 0) was not iterated.
Values iterations(const Measure& m, const ColumnTable& history, const Rows& rows)
{
  const auto values = quantity(history, m.quantity, rows);
  const auto steps = part_of(history.column("step"), rows);
  double sum = 0.0, largest = 0.0, n = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (steps[i] == 0.0) continue;
    sum += values[i];
    largest = std::max(largest, values[i]);
    n += 1.0;
  }
  MULLION_REQUIRE(n > 0.0, Errc::shape, "there is no step after the initial state");
  return {sum / n * m.scale, largest * m.scale};
}

} // namespace

double standard_deviation(std::span<const double> values)
{
  if (values.empty()) return 0.0;
  const double average = mean(values);
  double square = 0.0;
  for (const double v : values) square += (v - average) * (v - average);
  return std::sqrt(square / static_cast<double>(values.size()));
}

double envelope_rate(std::span<const double> times, std::span<const double> values, double window)
{
  MULLION_REQUIRE(times.size() >= 2, Errc::shape, "a rate needs two rows or more, there are {}", times.size());
  const double close = rounding * mean_step(times);
  const auto n = static_cast<std::size_t>((times.back() - times.front() + close) / window);
  MULLION_REQUIRE(n >= 2, Errc::shape, "the record of {} s has {} whole windows of {} s; a slope needs two",
                  times.back() - times.front(), n, window);
  double sum_x = 0.0, sum_y = 0.0, sum_xx = 0.0, sum_xy = 0.0;
  const auto begin_of = [&](std::size_t k) { // half-open windows: a border belongs to the later one
    const double border = times.front() + static_cast<double>(k) * window - close;
    return static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), border) - times.begin());
  };
  for (std::size_t k = 0; k < n; ++k) {
    const auto begin = begin_of(k);
    const double deviation = standard_deviation(values.subspan(begin, begin_of(k + 1) - begin));
    MULLION_REQUIRE(deviation > 0.0, Errc::numeric, "nothing varies in the window of {} s from {} s on", window,
                    times.front() + static_cast<double>(k) * window);
    const double x = static_cast<double>(k) - 0.5 * static_cast<double>(n - 1), y = std::log(deviation);
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  const auto count = static_cast<double>(n);
  return (sum_xy - sum_x * sum_y / count) / (sum_xx - sum_x * sum_x / count) / window;
}

Doubling error_doubling(std::span<const double> times, std::span<const double> values, double window,
                        std::optional<double> offset)
{
  check_window(times, window);
  const RunningDeviation deviation(values, offset, mean(values.first(n_within(times, window))));
  double first = 0.0, centre = 0.0;
  for (std::size_t begin = 0; begin < times.size(); ++begin) {
    if (times[begin] + window > times.back() + rounding * mean_step(times)) break;
    const double found = deviation.over(begin, begin + n_within(times.subspan(begin), window));
    centre = times[begin] - times.front() + 0.5 * window;
    if (begin == 0) {
      first = found;
      MULLION_REQUIRE(first > 0.0, Errc::numeric, "nothing varies in the first {} s, so that nothing can double",
                      window);
    }
    if (found > 2.0 * first) return {std::numbers::ln2 / centre, std::nullopt};
  }
  return {std::nullopt, std::numbers::ln2 / centre};
}

double deviation_ratio(std::span<const double> times, std::span<const double> values, double window)
{
  check_window(times, window);
  const auto n_first = n_within(times, window);
  const double begin = times.back() - window - rounding * mean_step(times);
  const auto last = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), begin) - times.begin());
  const double before = standard_deviation(values.first(n_first));
  MULLION_REQUIRE(before > 0.0, Errc::numeric, "nothing varies in the first {} s, so that there is no ratio", window);
  return standard_deviation(values.subspan(last)) / before;
}

std::vector<std::string> columns_of(const Measure& measure)
{
  if (measure.kind == "growth_rate") return {measure.name, measure.name + ".residual", measure.name + ".frequency"};
  if (measure.kind == "two_frequencies")
    return {measure.name, measure.name + ".second", measure.name + ".second_height"};
  if (measure.kind == "error_doubling") return {measure.name, measure.name + ".bound"};
  if (measure.kind == "iterations") return {measure.name, measure.name + ".max"};
  return {measure.name};
}

std::string quantity_of(const Measure& measure)
{
  std::string text = measure.quantity;
  for (const auto& [column, factor] : measure.terms)
    text += fmt::format("{}{}{}", text.empty() ? "" : " + ", factor == 1.0 ? "" : fmt::format("{} ", factor), column);
  return text;
}

std::string unit_of(const Measure& m)
{
  if (!m.unit.empty() || m.scale != 1.0) return m.unit;
  if (m.kind == "growth_rate" || m.kind == "envelope_rate" || m.kind == "error_doubling") return "1/s";
  if (m.kind == "dominant_frequency" || m.kind == "two_frequencies") return "Hz";
  if (m.kind == "first_time" || m.kind == "wall_time") return "s";
  if (m.kind == "ratio" || m.kind == "iterations" || m.kind == "steps") return "1";
  return m.kind == "drift" && !m.relative_to.empty() ? "1" : "";
}

Values evaluate(const Measure& m, const ColumnTable& history, const RunFacts& facts)
{
  if (m.kind == "wall_time") return {facts.wall_s * m.scale};
  if (m.kind == "steps") return {static_cast<double>(facts.steps) * m.scale};
  if (m.kind == "function") return function(m, facts);
  const Rows rows = rows_of(m, history);
  if (m.kind == "drift") return drift(m, history, rows);
  if (m.kind == "iterations") return iterations(m, history, rows);

  const auto values = quantity(history, m.quantity, rows);
  if (m.kind == "growth_rate") return growth(m, rows.times, values);
  if (m.kind == "envelope_rate") return {envelope_rate(rows.times, values, m.window) * m.scale};
  if (m.kind == "error_doubling") return doubling(m, rows.times, values);
  if (m.kind == "dominant_frequency") return frequency(m, rows.times, values);
  if (m.kind == "two_frequencies") return two_frequencies(m, rows.times, values);
  if (m.kind == "amplitude") return {run::amplitude(values) * m.scale};
  if (m.kind == "maximum") return {largest_magnitude(values) * m.scale};
  if (m.kind == "last") return {values.back() * m.scale};
  if (m.kind == "mean") return {mean(values) * m.scale};
  if (m.kind == "sum") return {mean(values) * static_cast<double>(values.size()) * m.scale};
  if (m.kind == "ratio") return {deviation_ratio(rows.times, values, m.window) * m.scale};
  if (m.kind == "first_time") return first_time(m, rows.times, values);
  MULLION_ASSERT(m.kind == "reference_error", "unknown kind of measure '{}'", m.kind);
  return reference_error(m, rows.times, values);
}

} // namespace mullion::study
