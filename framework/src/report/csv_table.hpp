// Tables as the report reads them: history.csv of a run, study.csv of a study. A column is numbers if all that stands
// in it is numbers or nothing, texts otherwise. Fields and quotes as in RFC 4180; lines may end with LF or CR LF.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::report {

struct CsvColumn {
  std::string name;
  std::vector<double> numbers;    ///< NaN where nothing stands; none in a column of texts
  std::vector<std::string> texts; ///< none in a column of numbers

  [[nodiscard]] bool is_text() const { return !texts.empty(); }
};

struct CsvTable {
  std::vector<CsvColumn> columns;
  std::size_t n_rows = 0;

  /// The column of that name, or nullptr.
  [[nodiscard]] const CsvColumn* find(std::string_view name) const;
};

/// What to do with a last line that no line end closes: text of a whole file, or of one that is being written.
enum class LastLine { whole, may_be_cut };

/// @param source  how messages name the text: a path
/// @throws Error  Errc::io, with the line: no header, a line of more or fewer fields than the header, an open quote
[[nodiscard]] CsvTable parse_csv(std::string_view text, const std::string& source, LastLine last_line);

/// The table in a file.
/// @throws Error Errc::io: unreadable, or as parse_csv()
[[nodiscard]] CsvTable read_csv(const std::filesystem::path& path, LastLine last_line);

} // namespace mullion::report
