#include "config/overrides.hpp"

#include "config/toml_reader.hpp"

#include <fmt/format.h>

namespace mullion::config {
namespace {

void apply_override(Node& root, const std::string& text, const Place& place, Diagnostics& diagnostics)
{
  const auto equals = text.find('=');
  if (equals == std::string::npos) {
    diagnostics.add(place, "has no '='; write --set table.key=value");
    return;
  }
  const auto keys = parse_key(text.substr(0, equals));
  if (!keys) {
    diagnostics.add(place, fmt::format("'{}' is no key; write --set table.key=value, with dots between the names",
                                       text.substr(0, equals)));
    return;
  }
  Node value = parse_value(text.substr(equals + 1), place);
  if (const auto* written = value.text(); written != nullptr && !is_valid_text(*written)) {
    diagnostics.add(place, "the value is not UTF-8 text");
    return;
  }
  Node* node = &root;
  for (std::size_t i = 0; i < keys->size(); ++i) {
    const auto& key = (*keys)[i];
    auto* table = node->table();
    if (table == nullptr) {
      diagnostics.add(place, fmt::format("'{}' is no table, so that '{}' cannot be set in it; --set reaches keys of "
                                         "tables only",
                                         (*keys)[i - 1], key));
      return;
    }
    auto* entry = table->find(key);
    if (entry == nullptr) entry = &table->entries.emplace_back(Entry{key, place, Node{place, Table{}}});
    else if (i + 1 == keys->size()) entry->place = place;
    node = &entry->value;
  }
  *node = std::move(value);
}

} // namespace

void apply_overrides(Node& root, const std::vector<std::string>& overrides, Diagnostics& diagnostics)
{
  int number = 0;
  for (const auto& text : overrides) apply_override(root, text, {++number, 1, "--set " + text}, diagnostics);
}

} // namespace mullion::config
