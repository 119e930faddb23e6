// The arrows between the parts: who may include whom, who may know whose name, who may print.
#include "architecture/source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <regex>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

namespace fs = std::filesystem;

bool starts_with(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

/// Every include of every file is standard or allowed.
void check_includes(const std::vector<std::string>& files,
                    const std::function<bool(const std::string&, const Include&)>& is_allowed)
{
  REQUIRE(!files.empty());
  for (const auto& file : files)
    for (const auto& include : includes_of(file))
      CHECK_MESSAGE((is_standard(include) || is_allowed(file, include)), file, " may not include ", include.name);
}

bool is_of(const Include& include, const std::vector<std::string>& folders)
{
  return !include.is_quoted && std::any_of(folders.begin(), folders.end(),
                                           [&](const auto& folder) { return starts_with(include.name, folder + "/"); });
}

/// "x.hpp" beside the file.
bool is_beside(const std::string& file, const Include& include)
{
  return include.is_quoted && include.name.find('/') == std::string::npos &&
         fs::exists(source_root() / fs::path(file).parent_path() / include.name);
}

/// "surface/x.hpp" of one of the folders under modules/.
bool is_of_folder(const Include& include, const std::vector<std::string>& folders)
{
  return include.is_quoted && std::any_of(folders.begin(), folders.end(), [&](const auto& folder) {
           return starts_with(folder, "modules/") && starts_with(include.name, last_part(folder) + "/") &&
                  fs::exists(source_root() / fs::path(folder).parent_path() / include.name);
         });
}

/// Kernels that several plug-ins share.
bool is_shared_kernel(const Include& include)
{
  static const auto folders = kernel_folders_of_tree();
  return is_of_folder(include, folders);
}

/// Module code that several plug-ins share.
bool is_shared_code(const Include& include)
{
  static const auto folders = shared_code_folders_of_tree();
  return is_of_folder(include, folders);
}

/// A plug-in's files but those of its Module or Driver class, whose names begin with the plug-in's: kernels.
std::vector<std::string> kernels_of(const std::string& folder)
{
  const auto name = last_part(folder);
  auto files = sources_under(folder);
  std::erase_if(files, [&](const auto& file) {
    const auto leaf = last_part(file);
    return leaf == name + ".hpp" || leaf == name + ".cpp" || starts_with(leaf, name + "_") || leaf == "plugin.cpp";
  });
  return files;
}

} // namespace

TEST_CASE("no file of the framework contains the name of a module or a driver")
{
  const auto files = files_under("framework", {".hpp", ".h", ".cpp", ".txt"});
  for (const auto& folder : plugin_folders_of_tree()) {
    const std::regex name("\\b" + last_part(folder) + "\\b");
    for (const auto& file : files)
      CHECK_MESSAGE(!std::regex_search(text_of(file), name), file, " names ", last_part(folder));
  }
}

TEST_CASE("the SDK knows the SDK, fmt and Eigen")
{
  check_includes(sources_under("framework/sdk"), [](const auto&, const Include& i) {
    return is_of(i, {"mullion/sdk", "fmt", "Eigen"});
  });
}

TEST_CASE("the coupling interface knows itself, the SDK and Eigen")
{
  check_includes(sources_under("framework/coupling"), [](const auto&, const Include& i) {
    return is_of(i, {"mullion/coupling", "mullion/sdk", "Eigen"});
  });
}

TEST_CASE("what the command line sees of the library is plain texts and numbers")
{
  check_includes(sources_under("framework/app"),
                 [](const auto&, const Include& i) { return is_of(i, {"mullion/app"}); });
  check_includes(sources_under("framework/cli"), [](const auto&, const Include& i) {
    if (i.is_quoted) return fs::exists(source_root() / "framework/cli" / i.name);
    return is_of(i, {"mullion/app", "fmt", "boost/program_options"}) || i.name == "mullion/sdk/error.hpp" ||
           i.name == "mullion/sdk/abi.h" || i.name == "mullion/coupling/build_id.hpp";
  });
}

TEST_CASE("the framework's sources include their own headers only")
{
  check_includes(sources_under("framework/src"), [](const auto&, const Include& i) {
    return i.is_quoted ? fs::exists(source_root() / "framework/src" / i.name) : true; // packages and public headers
  });
}

TEST_CASE("a module knows the SDK, its kernels and Eigen")
{
  auto folders = plugin_folders_of_tree();
  for (const auto& folder : shared_code_folders_of_tree()) folders.push_back(folder);
  for (const auto& folder : folders)
    if (starts_with(folder, "modules/"))
      check_includes(sources_under(folder), [](const auto& file, const Include& i) {
        return is_beside(file, i) || is_shared_kernel(i) || is_shared_code(i) ||
               is_of(i, {"mullion/sdk", "Eigen", "Spectra"});
      });
}

TEST_CASE("a driver knows the coupling interface, the SDK, its kernels and Eigen")
{
  for (const auto& folder : plugin_folders_of_tree())
    if (starts_with(folder, "drivers/"))
      check_includes(sources_under(folder), [](const auto& file, const Include& i) {
        return is_beside(file, i) || is_of(i, {"mullion/coupling", "mullion/sdk", "Eigen"});
      });
}

TEST_CASE("a kernel knows other kernels and Eigen: neither windows nor case files")
{
  bool is_any = false;
  auto folders = plugin_folders_of_tree();
  for (const auto& folder : kernel_folders_of_tree()) folders.push_back(folder);
  for (const auto& folder : folders)
    if (const auto kernels = kernels_of(folder); !kernels.empty()) {
      is_any = true;
      check_includes(kernels, [](const auto& file, const Include& i) {
        return is_beside(file, i) || is_shared_kernel(i) || is_of(i, {"Eigen", "Spectra"}); // Spectra: Eigen's kin
      });
    }
  CHECK(is_any);
}

TEST_CASE("libraries and plug-ins do not print")
{
  // Those that talk to the user, and the host, whose standard error the orchestrator reads.
  const std::vector<std::string> may_print = {"framework/cli/", "framework/src/host/",
                                              "framework/src/process/guard.cpp", "framework/src/run/simulation.cpp",
                                              "framework/src/run/under_guard.cpp"};
  const std::regex prints(R"re(std::(cout|cerr|clog)\b|\b(v?f?printf|f?puts|putchar|perror)\s*\(|fmt::print\s*\()re");
  for (const char* root : {"framework", "modules", "drivers"})
    for (const auto& file : sources_under(root)) {
      if (std::any_of(may_print.begin(), may_print.end(), [&](const auto& p) { return starts_with(file, p); }))
        continue;
      int number = 0;
      for (const auto& line : lines_of(file)) {
        ++number;
        CHECK_MESSAGE(!std::regex_search(line, prints), file, ":", number, " prints: ", line);
      }
    }
}

TEST_CASE("only the command line and the processes that are one end the process")
{
  const std::vector<std::string> may_exit = {"framework/cli/",
                                             "framework/src/host/",
                                             "framework/src/process/guard.cpp",
                                             "framework/src/process/child.cpp",
                                             "framework/src/process/supervisor.cpp",
                                             "framework/src/io/checkpoint_trial.cpp"};
  const std::regex exits(R"re((^|[^\w.>])(::|std::)?(_?exit|abort|quick_exit|_Exit)\s*\()re");
  for (const char* root : {"framework", "modules", "drivers"})
    for (const auto& file : sources_under(root)) {
      if (std::any_of(may_exit.begin(), may_exit.end(), [&](const auto& p) { return starts_with(file, p); })) continue;
      for (const auto& line : lines_of(file)) {
        const auto code = line.substr(0, line.find("//"));
        CHECK_MESSAGE(!std::regex_search(code, exits), file, " ends the process: ", line);
      }
    }
}

TEST_CASE("every source file says at its top what it is for")
{
  const auto opens_with_comment = [](const std::string& file) {
    const auto text = text_of(file);
    return starts_with(text, "// ") || starts_with(text, "/* ");
  };
  for (const char* root : {"framework", "modules", "drivers", "examples"})
    for (const auto& file : sources_under(root)) {
      if (last_part(file) == "plugin.cpp") continue; // one line
      const auto includes = includes_of(file);
      const auto stem = fs::path(file).stem();
      const bool is_implementation = fs::path(file).extension() == ".cpp" && !includes.empty() &&
                                     fs::path(includes[0].name).stem() == stem; // its header says it
      CHECK_MESSAGE((is_implementation || opens_with_comment(file)), file, " opens without a comment");
    }
}
