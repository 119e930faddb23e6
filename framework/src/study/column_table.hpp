// A CSV file of numbers as columns of doubles: what measures are taken from (history.csv, reference data).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace mullion::study {

struct ColumnTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns; ///< one a name, all of one length

  [[nodiscard]] bool has(std::string_view name) const;
  /// @throws Error Errc::config: no such column, with the nearest name
  [[nodiscard]] const std::vector<double>& column(std::string_view name) const;
};

/// Parse a header and lines of numbers (also nan, inf). A '#' before the header is left out, and so are empty lines
/// and further lines that start with one.
/// @param source  what to call the text in messages
/// @throws Error Errc::io: no header, a line with more or fewer cells than the header, or a cell that is no number
[[nodiscard]] ColumnTable parse_columns(std::string_view text, const std::string& source);

} // namespace mullion::study
