// The numbers that a study takes from each of its runs: pure functions of a history's columns. They know neither
// folders nor study files. A measure has no value (empty) where the quantity does not show it, say a doubling that
// never came; it throws where it cannot be taken at all, say of a column that is not there.
#pragma once

#include "study/column_table.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mullion::study {

/// One [[measure]], as it holds for one run. What a kind does not take stays at its default.
struct Measure {
  std::string name, kind, quantity;
  std::string unit;   ///< of the result, for tables and plots
  double scale = 1.0; ///< the result times it; of "reference_error": divided by it
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity(); ///< [s]
  double window = 0.0;                                                                                  ///< [s]
  std::optional<double> offset; ///< in the quantity's unit
  double above = 0.0;           ///< in the quantity's unit
  std::string norm = "max";     ///< or "rms"
  std::vector<std::pair<std::string, double>> terms;
  std::string relative_to;
  std::vector<double> reference_times, reference_values; ///< times in seconds
};

/// What is known of a run besides its history.
struct RunFacts {
  double wall_s = 0.0;
  std::int64_t steps = 0;
  std::vector<std::pair<std::string, double>> functions = {}; ///< asked for at the end, and the answers
};

/// Standard deviation about the mean; 0 without values.
[[nodiscard]] double standard_deviation(std::span<const double> values);

/// Least-squares slope of ln(standard deviation) over consecutive windows of `window`; growth is positive.
///
/// @param times   increasing
/// @return        [1/unit of times]
/// @throws Error  Errc::shape: fewer than two whole windows; Errc::numeric: nothing varies within one
[[nodiscard]] double envelope_rate(std::span<const double> times, std::span<const double> values, double window);

/// A rate from the time in which an error doubles (Jaiman et al. 2011, Eq. (21), the logarithm taken as natural):
///
///     lambda = ln 2 / t_r
///
/// t_r: from the begin of the record to the first centre of a sliding window whose standard deviation is more than
/// twice that of the first window.
struct Doubling {
  std::optional<double> rate;  ///< [1/unit of times]; none: not doubled
  std::optional<double> bound; ///< if not doubled: rate < ln 2 / (time of the last centre)
};

/// @param offset  deviations are from this value; none: from the mean of each window
/// @throws Error  Errc::shape: the record is shorter than the window; Errc::numeric: nothing varies in the first one
[[nodiscard]] Doubling error_doubling(std::span<const double> times, std::span<const double> values, double window,
                                      std::optional<double> offset);

/// Standard deviation over the last `window` by that over the first one.
/// @throws Error as error_doubling
[[nodiscard]] double deviation_ratio(std::span<const double> times, std::span<const double> values, double window);

/// The columns of the study's table that a measure fills: its name, and companions such as "<name>.residual".
[[nodiscard]] std::vector<std::string> columns_of(const Measure& measure);

/// What a measure looks at, in words: its column, or the sum of columns.
[[nodiscard]] std::string quantity_of(const Measure& measure);

/// The unit that was given; else that of the kind, "" where it depends on the quantity.
[[nodiscard]] std::string unit_of(const Measure& measure);

/// A value for each of columns_of(), in that order.
/// @throws Error  Errc::config: a column is missing; Errc::shape: too few rows; Errc::numeric: a value is not finite
[[nodiscard]] std::vector<std::optional<double>> evaluate(const Measure& measure, const ColumnTable& history,
                                                          const RunFacts& facts);

} // namespace mullion::study
