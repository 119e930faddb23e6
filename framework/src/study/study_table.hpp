// The one table of a study, a row per run in the order of their indices, and what is written from it: study.csv,
// study.h5, study.json and the rows that a terminal shows.
#pragma once

#include "io/atomic_file.hpp"
#include "study/run_result.hpp"
#include "study/study_file.hpp"

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::study {

struct Column {
  std::string name;
  std::string role;           ///< "index", "axis", "outcome", "measure", "message"
  std::string kind, quantity; ///< of a measure
  std::string unit;
  bool is_numeric = false;
  std::vector<std::string> cells; ///< "" where there is no value; numbers read back to the same double
};

using StudyTable = std::vector<Column>;

/// @param results  one a run; a run that is not done has no row
[[nodiscard]] StudyTable make_table(const StudyFile& study, std::span<const std::optional<RunResult>> results);

/// RFC 4180, but for line ends: '\n' alone.
[[nodiscard]] std::string csv_text(const StudyTable& table);

/// A one-dimensional dataset a column; numbers as doubles, NaN where there is no value.
[[nodiscard]] io::Bytes hdf5_file(const StudyTable& table);

/// Columns side by side for a terminal, the first rows only, numbers with six digits.
[[nodiscard]] std::string printed(const StudyTable& table, std::size_t max_rows);

/// Name, case, axes, measures and counts.
[[nodiscard]] std::string json_text(const StudyFile& study, std::span<const std::optional<RunResult>> results,
                                    double wall_s);

} // namespace mullion::study
