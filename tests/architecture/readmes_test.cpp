// Each plug-in's README: the sections that a reader expects, and the parameters as `mullion modules NAME` prints them.
#include "architecture/source_tree.hpp"

#include <mullion/app/catalogue.hpp>

#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::test;

namespace {

using Row = std::vector<std::string>;

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

/// The cells of "| a | b \| c |".
Row cells_of(const std::string& line)
{
  Row cells;
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|') cell += line[++i];
    else if (line[i] == '|') {
      cells.push_back(trimmed(cell));
      cell.clear();
    } else cell += line[i];
  }
  return cells;
}

/// The first table under "## Parameters": head, rule and rows; empty if there is none.
std::vector<Row> parameter_table(const std::string& readme)
{
  std::vector<Row> rows;
  bool is_there = false;
  for (const auto& line : lines_of(readme)) {
    if (line.rfind("## ", 0) == 0) is_there = line == "## Parameters";
    else if (is_there && line.rfind('|', 0) == 0) rows.push_back(cells_of(line));
    else if (!rows.empty()) break;
  }
  return rows;
}

std::vector<Row> declared_table(const PluginReference& plugin)
{
  if (plugin.parameters.empty()) return {};
  std::vector<Row> rows = {{"name", "type", "unit", "default", "range", "meaning"}, Row(6, "---")};
  for (const auto& p : plugin.parameters) rows.push_back({p.name, p.type, p.unit, p.fallback, p.range, p.meaning});
  return rows;
}

} // namespace

TEST_CASE("the parameter table of each plug-in's README is what the plug-in declares")
{
  ::setenv("MULLION_PLUGIN_PATH", MULLION_BUILD_DIR "/lib/mullion/plugins", 1);
  for (const auto& folder : plugin_folders_of_tree()) {
    const auto readme = parameter_table(folder + "/README.md");

    const auto declared = declared_table(describe_plugin(last_part(folder)));

    REQUIRE_MESSAGE(readme.size() == declared.size(), folder, "/README.md: rows of the table under '## Parameters'");
    for (std::size_t row = 0; row < readme.size(); ++row) {
      REQUIRE_MESSAGE(readme[row].size() == 6, folder, "/README.md, row ", row);
      for (std::size_t c = 0; c < 6; ++c)
        CHECK_MESSAGE(readme[row][c] == declared[row][c], folder, "/README.md, parameter ", declared[row][0]);
    }
  }
}

TEST_CASE("every declared parameter, field and function says what it means")
{
  ::setenv("MULLION_PLUGIN_PATH", MULLION_BUILD_DIR "/lib/mullion/plugins", 1);
  for (const auto& folder : plugin_folders_of_tree()) {
    const auto plugin = describe_plugin(last_part(folder));

    CHECK_MESSAGE(!plugin.summary.summary.empty(), folder);
    for (const auto& p : plugin.parameters) CHECK_MESSAGE(!p.meaning.empty(), folder, ": parameter ", p.name);
    for (const auto& f : plugin.fields) CHECK_MESSAGE(!f.meaning.empty(), folder, ": field ", f.name);
    for (const auto& f : plugin.inputs) CHECK_MESSAGE(!f.meaning.empty(), folder, ": input ", f.name);
    for (const auto& f : plugin.functions) CHECK_MESSAGE(!f.meaning.empty(), folder, ": function ", f.name);
  }
}

TEST_CASE("each plug-in's README has the sections that a reader expects")
{
  for (const auto& folder : plugin_folders_of_tree()) {
    const auto text = text_of(folder + "/README.md");

    CHECK_MESSAGE(text.rfind("# " + last_part(folder), 0) == 0, folder, "/README.md: title");
    for (const char* section : {"## Equations", "## Windows", "## Parameters", "## Verification", "## Known limits"})
      CHECK_MESSAGE(text.find(std::string(section) + "\n") != std::string::npos, folder, "/README.md: ", section);
  }
}
