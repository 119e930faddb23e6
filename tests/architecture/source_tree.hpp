// The source tree as the architecture tests read it: files, texts, lines, includes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mullion::test {

/// The root of the source tree.
std::filesystem::path source_root();

/// Files under a folder of the source tree whose names end in one of these, as paths from the root, sorted. Build
/// folders, results and hidden folders don't count.
std::vector<std::string> files_under(const std::string& folder, const std::vector<std::string>& endings);

/// C++ and C sources and headers.
std::vector<std::string> sources_under(const std::string& folder);

/// The whole file. @param file path from the root
std::string text_of(const std::string& file);
std::vector<std::string> lines_of(const std::string& file);

struct Include {
  std::string name;
  bool is_quoted; ///< "name" rather than <name>
};
std::vector<Include> includes_of(const std::string& file);

/// A C++ standard header or one of the system: no folder in it.
bool is_standard(const Include& include);

/// Folders of modules/ and drivers/ whose CMakeLists.txt adds a module or a driver.
std::vector<std::string> plugin_folders_of_tree();

/// Libraries of kernels that several plug-ins share.
std::vector<std::string> kernel_folders_of_tree();

/// Those without a CMakeLists.txt of their own: module code that several plug-ins compile.
std::vector<std::string> shared_code_folders_of_tree();

/// "modules/fluid/euler_1d" -> "euler_1d"
std::string last_part(const std::string& path);

} // namespace mullion::test
