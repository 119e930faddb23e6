#include "report/csv_table.hpp"

#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <charconv>
#include <limits>

namespace mullion::report {
namespace {

/// Goes through the fields of a text, one after the other.
class Scanner {
public:
  Scanner(std::string_view text, const std::string& source) : rest_(text), source_(source) {}

  [[nodiscard]] bool is_at_end() const { return rest_.empty(); }
  [[nodiscard]] int line() const { return line_; }

  /// The next field, without its quotes. @return does another one follow on this line?
  bool next(std::string& field)
  {
    field.clear();
    if (rest_.starts_with('"')) read_quoted(field);
    const auto end = std::min(rest_.find_first_of(",\n"), rest_.size());
    auto plain = rest_.substr(0, end);
    const bool is_last = end == rest_.size() || rest_[end] == '\n';
    if (is_last && plain.ends_with('\r')) plain.remove_suffix(1);
    field += plain;
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    if (is_last) ++line_;
    return !is_last;
  }

private:
  void read_quoted(std::string& field)
  {
    const int begin = line_;
    rest_.remove_prefix(1);
    while (true) {
      const auto quote = rest_.find('"');
      MULLION_REQUIRE(quote != std::string_view::npos, Errc::io, "{}, line {}: a quote is opened and never closed",
                      source_, begin);
      field += rest_.substr(0, quote);
      line_ += static_cast<int>(std::count(rest_.begin(), rest_.begin() + static_cast<long>(quote), '\n'));
      rest_.remove_prefix(quote + 1);
      if (!rest_.starts_with('"')) return; // or it is a doubled one: a quote within the text
      field += '"';
      rest_.remove_prefix(1);
    }
  }

  std::string_view rest_;
  const std::string& source_;
  int line_ = 1;
};

bool to_number(const std::string& field, double& value)
{
  value = std::numeric_limits<double>::quiet_NaN();
  if (field.empty()) return true;
  const auto* end = field.data() + field.size();
  const auto parsed = std::from_chars(field.data(), end, value);
  return parsed.ec == std::errc{} && parsed.ptr == end;
}

/// Calls `take(column, field)` for every field behind the header.
/// @return the number of rows
template <class Take>
std::size_t for_each_field(Scanner scanner, const std::string& source, std::size_t n_columns, Take take)
{
  std::size_t n_rows = 0;
  std::string field;
  for (; !scanner.is_at_end(); ++n_rows) {
    const int line = scanner.line();
    std::size_t n_fields = 0;
    for (bool is_more = true; is_more; ++n_fields) {
      is_more = scanner.next(field);
      if (n_fields < n_columns) take(n_fields, field);
    }
    MULLION_REQUIRE(n_fields == n_columns, Errc::io, "{}, line {}: {} fields, but the header has {}", source, line,
                    n_fields, n_columns);
  }
  return n_rows;
}

} // namespace

const CsvColumn* CsvTable::find(std::string_view name) const
{
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

CsvTable parse_csv(std::string_view text, const std::string& source, LastLine last_line)
{
  if (last_line == LastLine::may_be_cut) text = text.substr(0, text.rfind('\n') + 1); // npos + 1 is 0: nothing
  MULLION_REQUIRE(!text.empty(), Errc::io, "{}: no header, expected the names of the columns", source);
  CsvTable table;
  Scanner scanner(text, source);
  for (bool is_more = true; is_more;) is_more = scanner.next(table.columns.emplace_back().name);

  // Numbers first; the few columns that turn out to be texts are read in a second pass.
  std::vector<char> is_text(table.columns.size(), 0);
  table.n_rows = for_each_field(scanner, source, table.columns.size(), [&](std::size_t c, const std::string& field) {
    double value = 0.0;
    if (is_text[c] == 0 && !to_number(field, value)) is_text[c] = 1;
    if (is_text[c] == 0) table.columns[c].numbers.push_back(value);
  });
  if (std::find(is_text.begin(), is_text.end(), 1) == is_text.end()) return table;
  for (std::size_t c = 0; c < table.columns.size(); ++c)
    if (is_text[c] != 0) table.columns[c].numbers.clear();
  for_each_field(scanner, source, table.columns.size(), [&](std::size_t c, const std::string& field) {
    if (is_text[c] != 0) table.columns[c].texts.push_back(field);
  });
  return table;
}

CsvTable read_csv(const std::filesystem::path& path, LastLine last_line)
{
  return parse_csv(io::read_text(path), path.string(), last_line);
}

} // namespace mullion::report
