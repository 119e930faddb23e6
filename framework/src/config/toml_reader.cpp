#include "config/toml_reader.hpp"

#include "config/toml_writer.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>
#include <tuple>

namespace mullion::config {
namespace {

/// Places from the parser's source positions, or one place for everything (a command-line flag).
class Converter {
public:
  explicit Converter(const Place* everywhere) : everywhere_(everywhere) {}

  [[nodiscard]] Node convert(const toml::node& node) const
  {
    Node out{place(node.source()), false};
    if (const auto* table = node.as_table()) out.value = convert_table(*table);
    else if (const auto* array = node.as_array()) {
      List list;
      for (const auto& element : *array) list.push_back(convert(element));
      out.value = std::move(list);
    } else if (const auto* text = node.as_string()) out.value = text->get();
    else if (const auto* integer = node.as_integer()) out.value = integer->get();
    else if (const auto* real = node.as_floating_point()) out.value = real->get();
    else if (const auto* boolean = node.as_boolean()) out.value = boolean->get();
    else out.value = Date{written(node)};
    return out;
  }

private:
  [[nodiscard]] Table convert_table(const toml::table& table) const
  {
    Table out;
    for (const auto& [key, value] : table)
      out.entries.push_back({std::string(key.str()), place(key.source()), convert(value)});
    // the library sorts by name; a reader of messages and of case.toml wants the file's order
    std::stable_sort(out.entries.begin(), out.entries.end(), [](const Entry& a, const Entry& b) {
      return std::tuple(a.place.line, a.place.column) < std::tuple(b.place.line, b.place.column);
    });
    return out;
  }
  [[nodiscard]] Place place(const toml::source_region& region) const
  {
    if (everywhere_ != nullptr) return *everywhere_;
    return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column), ""};
  }
  static std::string written(const toml::node& node)
  {
    std::ostringstream out;
    if (const auto* date = node.as_date()) out << date->get();
    else if (const auto* time = node.as_time()) out << time->get();
    else if (const auto* both = node.as_date_time()) out << both->get();
    return out.str();
  }
  const Place* everywhere_;
};

/// The TOML library limits how deep values nest, but not of how many parts a key is, and each part is a table in a
/// table: some ten thousand of them end the process, for lack of stack. A case's keys have two or three.
constexpr int most_key_parts = 8;

bool is_bare(char c)
{
  return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '_' || c == '-';
}

/// Behind the part of a key that starts at `at`: bare, or between quotes that close on the same line.
std::size_t end_of_part(std::string_view text, std::size_t at)
{
  if (is_bare(text[at])) {
    while (at < text.size() && is_bare(text[at])) ++at;
    return at;
  }
  for (auto end = at + 1; end < text.size() && text[end] != '\n'; ++end) {
    if (text[end] == text[at]) return end + 1;
    if (text[end] == '\\' && text[at] == '"') ++end;
  }
  return at + 1;
}

/// Where the first key of too many parts stands, if there is one; as keys, all that could be one is counted.
std::optional<Place> find_long_key(std::string_view text)
{
  int line = 1, n_parts = 0;
  bool is_behind_dot = false;
  std::size_t line_begin = 0, key_begin = 0;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    if (is_bare(c) || c == '"' || c == '\'') {
      if (!is_behind_dot) {
        n_parts = 0;
        key_begin = i;
      }
      if (++n_parts > most_key_parts) return Place{line, static_cast<int>(key_begin - line_begin) + 1, ""};
      is_behind_dot = false;
      i = end_of_part(text, i);
      continue;
    }
    ++i;
    if (c == '.') is_behind_dot = n_parts > 0;
    else if (c != ' ' && c != '\t') {
      n_parts = 0;
      is_behind_dot = false;
    }
    if (c != '\n') continue;
    ++line;
    line_begin = i;
  }
  return std::nullopt;
}

std::optional<toml::table> try_parse(const std::string& text)
{
  if (find_long_key(text)) return std::nullopt;
  try {
    return toml::parse(std::string_view(text));
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

} // namespace

std::variant<Node, SyntaxError> parse_toml(const std::string& text)
{
  if (const auto place = find_long_key(text))
    return SyntaxError{*place,
                       fmt::format("a key of more than {} parts; expected a table's name and a key's", most_key_parts)};
  try {
    Node root = Converter(nullptr).convert(toml::parse(std::string_view(text)));
    root.place = {};
    return root;
  } catch (const toml::parse_error& error) {
    const auto& at = error.source().begin;
    return SyntaxError{{static_cast<int>(at.line), static_cast<int>(at.column), ""},
                       fmt::format("not valid TOML: {}", error.description())};
  }
}

Node parse_value(const std::string& text, const Place& place)
{
  // Inside a list a comment swallows the bracket and a second value makes two: neither passes for one value.
  const bool has_comma_behind = !text.empty() && text.back() == ',';
  if (const auto document = try_parse("value = [" + text + "]"); document && !has_comma_behind) {
    const auto* values = document->get_as<toml::array>("value");
    if (document->size() == 1 && values != nullptr && values->size() == 1)
      return Converter(&place).convert(*values->get(0));
  }
  return {place, text};
}

bool is_valid_text(const std::string& text)
{
  Node node;
  node.value = text;
  return try_parse("value = " + write_value(node)).has_value();
}

std::optional<std::vector<std::string>> parse_key(const std::string& text)
{
  if (text.find_first_of("\r\n=#[]{}") != std::string::npos) return std::nullopt;
  const auto document = try_parse(text + " = 0");
  if (!document) return std::nullopt;
  std::vector<std::string> parts;
  for (const toml::table* table = &*document; table != nullptr && table->size() == 1;) {
    const auto first = table->cbegin(); // holds what * and -> refer to
    parts.emplace_back(first->first.str());
    table = first->second.as_table();
  }
  return parts;
}

} // namespace mullion::config
