#include "study/column_table.hpp"

#include "config/suggestions.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <charconv>

namespace mullion::study {
namespace {

std::string_view trimmed(std::string_view text)
{
  constexpr std::string_view blanks = " \t\r";
  const auto begin = text.find_first_not_of(blanks);
  return begin == std::string_view::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

/// What stands before the separator, which goes too.
std::string_view take(std::string_view& text, char separator)
{
  const auto end = std::min(text.find(separator), text.size());
  const auto part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return trimmed(part);
}

} // namespace

bool ColumnTable::has(std::string_view name) const
{
  return std::find(names.begin(), names.end(), name) != names.end();
}

const std::vector<double>& ColumnTable::column(std::string_view name) const
{
  const auto found = std::find(names.begin(), names.end(), name);
  MULLION_REQUIRE(found != names.end(), Errc::config, "there is no column '{}'{}", name,
                  config::suggestion(name, names));
  return columns[static_cast<std::size_t>(found - names.begin())];
}

ColumnTable parse_columns(std::string_view text, const std::string& source)
{
  ColumnTable table;
  auto header = take(text, '\n');
  if (header.starts_with('#')) header = trimmed(header.substr(1));
  MULLION_REQUIRE(!header.empty(), Errc::io, "{} has no header; expected the names of its columns in the first line",
                  source);
  while (!header.empty()) table.names.emplace_back(take(header, ','));
  table.columns.resize(table.names.size());
  for (int number = 2; !text.empty(); ++number) {
    auto line = take(text, '\n');
    if (line.empty() || line.starts_with('#')) continue;
    std::size_t c = 0;
    for (bool is_more = true; is_more; ++c) {
      is_more = line.find(',') != std::string_view::npos;
      const auto cell = take(line, ',');
      double value = 0.0;
      const auto parsed = std::from_chars(cell.data(), cell.data() + cell.size(), value);
      MULLION_REQUIRE(c < table.names.size(), Errc::io, "{}:{}: more cells than the {} of the header", source, number,
                      table.names.size());
      MULLION_REQUIRE(parsed.ec == std::errc{} && parsed.ptr == cell.data() + cell.size(), Errc::io,
                      "{}:{}: '{}' in column '{}' is no number", source, number, cell, table.names[c]);
      table.columns[c].push_back(value);
    }
    MULLION_REQUIRE(c == table.names.size(), Errc::io, "{}:{}: {} cells; expected {} as in the header", source, number,
                    c, table.names.size());
  }
  return table;
}

} // namespace mullion::study
