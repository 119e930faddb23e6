#include "architecture/source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>

namespace mullion::test {

namespace fs = std::filesystem;

fs::path source_root() { return MULLION_SOURCE_DIR; }

std::vector<std::string> files_under(const std::string& folder, const std::vector<std::string>& endings)
{
  std::vector<std::string> files;
  for (auto it = fs::recursive_directory_iterator(source_root() / folder); it != fs::recursive_directory_iterator();
       ++it) {
    const auto name = it->path().filename().string();
    const bool is_skipped = name.front() == '.' || name.rfind("build", 0) == 0 || name == "out";
    if (it->is_directory() && is_skipped) it.disable_recursion_pending();
    if (!it->is_regular_file()) continue;
    if (std::any_of(endings.begin(), endings.end(), [&](const auto& ending) { return name.ends_with(ending); }))
      files.push_back(fs::relative(it->path(), source_root()).string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> sources_under(const std::string& folder)
{
  return files_under(folder, {".hpp", ".h", ".cpp"});
}

std::string text_of(const std::string& file)
{
  std::ifstream in(source_root() / file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

std::vector<std::string> lines_of(const std::string& file)
{
  std::istringstream text(text_of(file));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::vector<Include> includes_of(const std::string& file)
{
  static const std::regex pattern(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<Include> includes;
  std::smatch match;
  for (const auto& line : lines_of(file))
    if (std::regex_search(line, match, pattern)) includes.push_back({match[2], match[1] == "\""});
  return includes;
}

bool is_standard(const Include& include) { return !include.is_quoted && include.name.find('/') == std::string::npos; }

namespace {

enum class FolderKind { plugin, kernels, shared_code };

/// What a folder of sources under modules/ or drivers/ is: its CMakeLists.txt tells.
FolderKind kind_of(const std::string& folder)
{
  const auto list = folder + "/CMakeLists.txt";
  if (!fs::exists(source_root() / list)) return FolderKind::shared_code;
  const bool is_plugin = text_of(list).find("mullion_add_module(") != std::string::npos ||
                         text_of(list).find("mullion_add_driver(") != std::string::npos;
  return is_plugin ? FolderKind::plugin : FolderKind::kernels;
}

std::vector<std::string> folders_of_tree(FolderKind kind)
{
  std::set<std::string> folders;
  for (const char* root : {"modules", "drivers"})
    for (const auto& file : sources_under(root)) {
      const auto folder = fs::path(file).parent_path().string();
      if (folder != root && kind_of(folder) == kind) folders.insert(folder);
    }
  return {folders.begin(), folders.end()};
}

} // namespace

std::vector<std::string> plugin_folders_of_tree() { return folders_of_tree(FolderKind::plugin); }

std::vector<std::string> kernel_folders_of_tree() { return folders_of_tree(FolderKind::kernels); }

std::vector<std::string> shared_code_folders_of_tree() { return folders_of_tree(FolderKind::shared_code); }

std::string last_part(const std::string& path) { return fs::path(path).filename().string(); }

} // namespace mullion::test

TEST_CASE("the tests look at the tree that they belong to")
{
  using namespace mullion::test;

  CHECK(sources_under("framework").size() > 50);
  CHECK(plugin_folders_of_tree().size() >= 5);
  CHECK(kernel_folders_of_tree().size() >= 1);
  CHECK(includes_of("framework/sdk/include/mullion/sdk/abi.h").size() == 1);
}
