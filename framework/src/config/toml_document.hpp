// A TOML document as plain data in which every key and value knows its place: what the case reader works on, so
// that one source file alone sees the TOML library. Tables keep the order of the file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace mullion::config {

/// Where a key or a value stands: in the file, or on the command line.
struct Place {
  int line = 1, column = 1; ///< 1-based; of a flag: its number on the command line
  std::string flag;         ///< "--set fluid.cells=10"; empty: in the file
};

struct Node;
struct Entry;
using List = std::vector<Node>;

struct Table {
  std::vector<Entry> entries;

  [[nodiscard]] const Entry* find(std::string_view key) const;
  [[nodiscard]] Entry* find(std::string_view key);
};

/// A date or a time: legal TOML that no key of a case wants; kept as written for messages.
struct Date {
  std::string text;
};

struct Node {
  Place place; ///< of the value; of a table: its header
  std::variant<bool, std::int64_t, double, std::string, Date, List, Table> value;

  [[nodiscard]] const Table* table() const { return std::get_if<Table>(&value); }
  [[nodiscard]] Table* table() { return std::get_if<Table>(&value); }
  [[nodiscard]] const List* list() const { return std::get_if<List>(&value); }
  [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&value); }
  [[nodiscard]] const bool* boolean() const { return std::get_if<bool>(&value); }
};

struct Entry {
  std::string key;
  Place place; ///< of the key
  Node value;
};

inline const Entry* Table::find(std::string_view key) const
{
  for (const auto& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}
inline Entry* Table::find(std::string_view key)
{
  for (auto& entry : entries)
    if (entry.key == key) return &entry;
  return nullptr;
}

} // namespace mullion::config
