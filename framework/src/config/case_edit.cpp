#include "config/case_edit.hpp"

#include "config/case_reader.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>

namespace mullion::config {
namespace {

Node parse(const std::string& text)
{
  auto parsed = parse_toml(text);
  MULLION_ASSERT(std::holds_alternative<Node>(parsed), "the case's own text is no TOML");
  return std::get<Node>(std::move(parsed));
}

Table& table_of(Node& root, const std::string& name)
{
  auto* entry = root.table()->find(name);
  if (entry == nullptr) entry = &root.table()->entries.emplace_back(Entry{name, {}, Node{{}, Table{}}});
  return *entry->value.table();
}

void put(Table& table, const ParameterValue& value)
{
  auto* entry = table.find(value.name);
  if (entry == nullptr) entry = &table.entries.emplace_back(Entry{value.name, {}, {}});
  std::visit([&](const auto& v) { entry->value.value = v; }, value.value);
}

} // namespace

std::string edit_plugin(const std::string& text, const std::string& table, const std::string& name_key,
                        const std::string& plugin, const std::vector<ParameterValue>& parameters)
{
  auto root = parse(text);
  auto& keys = table_of(root, table);
  const auto is_here = [](const ParameterValue& p) { return p.is_given && p.name != reference_pressure; };
  std::erase_if(keys.entries, [&](const Entry& entry) {
    return entry.key != name_key && entry.key != "process" &&
           std::none_of(parameters.begin(), parameters.end(),
                        [&](const ParameterValue& p) { return is_here(p) && p.name == entry.key; });
  });
  put(keys, {name_key, plugin, true});
  for (const auto& parameter : parameters)
    if (is_here(parameter)) put(keys, parameter);
  return write_toml(root);
}

std::string edit_key(const std::string& text, const std::string& table, const ParameterValue& value)
{
  auto root = parse(text);
  put(table_of(root, table), value);
  return write_toml(root);
}

} // namespace mullion::config
