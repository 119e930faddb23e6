// `mullion modules [NAME]`: which plug-ins there are; what one of them declares.
#include "commands/arguments.hpp"

#include <mullion/app/catalogue.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace mullion::cli {
namespace {

using Row = std::vector<std::string>;

/// Characters that a terminal shows: bytes that don't continue a UTF-8 sequence.
std::size_t width(const std::string& text)
{
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

/// Columns as wide as their widest cell, two blanks between them; the last one as it comes.
void print_table(const std::string& indent, const Row& head, std::vector<Row> rows)
{
  rows.insert(rows.begin(), head);
  std::vector<std::size_t> widths(head.size(), 0);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  for (const auto& row : rows) {
    std::string line = indent;
    for (std::size_t c = 0; c < row.size(); ++c) {
      line += row[c];
      if (c + 1 < row.size()) line.append(widths[c] - width(row[c]) + 2, ' ');
    }
    fmt::print("{}\n", line);
  }
}

void print_fields(const char* heading, const char* role, const std::vector<FieldRow>& fields)
{
  if (fields.empty()) return;
  std::vector<Row> rows;
  for (const auto& f : fields) rows.push_back({f.name, f.unit, f.location, f.components, f.role, f.nature, f.meaning});
  fmt::print("\n{}\n", heading);
  print_table("  ", {"name", "unit", "on", "components", role, "nature", "meaning"}, std::move(rows));
}

void print_reference(const PluginReference& plugin)
{
  const auto& [name, kind, version, summary, path, problem] = plugin.summary;
  fmt::print("{} {}: {} ({})\n{}\n", name, version, summary, kind, path);
  if (!plugin.parameters.empty()) {
    std::vector<Row> rows;
    for (const auto& p : plugin.parameters) rows.push_back({p.name, p.type, p.unit, p.fallback, p.range, p.meaning});
    fmt::print("\nparameters\n");
    print_table("  ", {"name", "type", "unit", "default", "range", "meaning"}, std::move(rows));
  }
  print_fields("fields", "role", plugin.fields);
  print_fields("inputs", "need", plugin.inputs);
  if (plugin.functions.empty()) return;
  std::vector<Row> rows;
  for (const auto& f : plugin.functions) rows.push_back({f.name, f.signature, f.meaning});
  fmt::print("\nfunctions\n");
  print_table("  ", {"name", "signature", "meaning"}, std::move(rows));
}

void print_list(const std::vector<PluginSummary>& plugins)
{
  std::vector<Row> rows;
  for (const auto& plugin : plugins)
    if (plugin.problem.empty()) rows.push_back({plugin.kind, plugin.name, plugin.version, plugin.summary});
  if (rows.empty())
    fmt::print("no plug-ins in {}; MULLION_PLUGIN_PATH adds folders\n", fmt::join(plugin_folders(), ", "));
  else print_table("", {"kind", "name", "version", "summary"}, std::move(rows));
  std::fflush(stdout); // the table first, where both streams are one terminal
  for (const auto& plugin : plugins)
    if (!plugin.problem.empty()) fmt::print(stderr, "mullion: warning: {}\n", plugin.problem);
}

} // namespace

int run_modules(const Arguments& arguments)
{
  const CommandLine command{"mullion modules [NAME]",
                            "List the modules and drivers on the plug-in path, or all that one of them declares.",
                            {},
                            "name"};
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("name") == 0) print_list(list_plugins());
  else print_reference(describe_plugin((*given)["name"].as<std::vector<std::string>>()[0]));
  return success;
}

} // namespace mullion::cli
