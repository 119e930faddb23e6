#include "config/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mullion::config {
namespace {

bool is_bare(const std::string& key)
{
  const auto is_letter = [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '_' || c == '-';
  };
  return !key.empty() && std::all_of(key.begin(), key.end(), is_letter);
}

std::string quoted(const std::string& text)
{
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') (out += '\\') += c;
    else if (c == '\n') out += "\\n";
    else if (c == '\t') out += "\\t";
    else if (code < 0x20 || code == 0x7f) out += fmt::format("\\u{:04x}", code);
    else out += c;
  }
  return out + '"';
}

std::string key_text(const std::string& key) { return is_bare(key) ? key : quoted(key); }

std::string inline_table(const Table& table)
{
  std::vector<std::string> parts;
  for (const auto& entry : table.entries)
    parts.push_back(fmt::format("{} = {}", key_text(entry.key), write_value(entry.value)));
  return parts.empty() ? "{}" : fmt::format("{{ {} }}", fmt::join(parts, ", "));
}

bool is_list_of_tables(const Node& node)
{
  const auto* list = node.list();
  return list != nullptr && !list->empty() &&
         std::all_of(list->begin(), list->end(), [](const Node& n) { return n.table() != nullptr; });
}

void write_section(std::string& out, const std::string& header, const Table& table)
{
  if (!out.empty()) out += '\n';
  out += header + '\n';
  for (const auto& entry : table.entries)
    out += fmt::format("{} = {}\n", key_text(entry.key), write_value(entry.value));
}

} // namespace

std::string write_real(double value)
{
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value < 0 ? "-inf" : "inf";
  std::string out = fmt::format("{}", value); // shortest that reads back to the same bits
  if (out.find_first_of(".e") == std::string::npos) out += ".0";
  return out;
}

std::string write_value(const Node& node)
{
  struct Write {
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(double value) const { return write_real(value); }
    std::string operator()(const std::string& value) const { return quoted(value); }
    std::string operator()(const Date& value) const { return value.text; }
    std::string operator()(const List& list) const
    {
      std::vector<std::string> parts;
      for (const auto& element : list) parts.push_back(write_value(element));
      return fmt::format("[{}]", fmt::join(parts, ", "));
    }
    std::string operator()(const Table& table) const { return inline_table(table); }
  };
  return std::visit(Write{}, node.value);
}

std::string describe(const Node& node)
{
  struct Kind {
    std::string operator()(bool) const { return "a boolean"; }
    std::string operator()(std::int64_t) const { return "an integer"; }
    std::string operator()(double) const { return "a real number"; }
    std::string operator()(const std::string&) const { return "a text"; }
    std::string operator()(const Date&) const { return "a date or time"; }
    std::string operator()(const List&) const { return "a list"; }
    std::string operator()(const Table&) const { return "a table"; }
  };
  return fmt::format("{} is {}", write_value(node), std::visit(Kind{}, node.value));
}

std::string write_toml(const Node& root)
{
  std::string out;
  for (const auto& entry : root.table()->entries) // bare keys first: behind a header they would belong to it
    if (entry.value.table() == nullptr && !is_list_of_tables(entry.value))
      out += fmt::format("{} = {}\n", key_text(entry.key), write_value(entry.value));
  for (const auto& entry : root.table()->entries) {
    if (const auto* table = entry.value.table()) write_section(out, fmt::format("[{}]", key_text(entry.key)), *table);
    else if (is_list_of_tables(entry.value))
      for (const auto& element : *entry.value.list())
        write_section(out, fmt::format("[[{}]]", key_text(entry.key)), *element.table());
  }
  return out;
}

} // namespace mullion::config
