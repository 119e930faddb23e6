#include "plugin/catalogue.hpp"

#include "config/suggestions.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace mullion::plugin {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view extension = ".so";

std::vector<std::string> plugin_path()
{
  std::vector<std::string> folders;
  const auto add = [&](const std::string& folder) {
    if (!folder.empty() && std::find(folders.begin(), folders.end(), folder) == folders.end())
      folders.push_back(folder);
  };
  if (const char* variable = std::getenv("MULLION_PLUGIN_PATH"); variable != nullptr) {
    std::string_view rest = variable;
    while (!rest.empty()) {
      const auto end = std::min(rest.find(':'), rest.size());
      add(std::string(rest.substr(0, end)));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (error) return folders; // no /proc: the variable alone counts
  const fs::path here = executable.parent_path();
  if (here.filename() == "mullion" && here.parent_path().filename() == "lib")
    add((here / "plugins").string());                                      // mullion-host
  else add((here.parent_path() / "lib" / "mullion" / "plugins").string()); // bin/mullion
  return folders;
}

} // namespace

Catalogue::Catalogue() : folders_(plugin_path()) {}

std::vector<std::string> Catalogue::names() const
{
  std::vector<std::string> names;
  for (const auto& folder : folders_) {
    std::error_code error; // a folder of the path may be missing
    for (const auto& entry : fs::directory_iterator(folder, error))
      if (entry.path().extension() == extension && entry.is_regular_file(error))
        names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

std::string Catalogue::find(const std::string& name) const
{
  if (name.empty() || name.find('/') != std::string::npos) return ""; // a name, never a path
  for (const auto& folder : folders_) {
    std::error_code error;
    const fs::path path = fs::path(folder) / (name + std::string(extension));
    if (fs::is_regular_file(path, error)) return path.string();
  }
  return "";
}

const Library& Catalogue::open(const std::string& name)
{
  for (const auto& [known, library] : open_)
    if (known == name) return *library;
  MULLION_REQUIRE(name.find('/') == std::string::npos, Errc::plugin,
                  "'{}' is a path; a plug-in is named, and its folder put on MULLION_PLUGIN_PATH", name);
  const auto path = find(name);
  MULLION_REQUIRE(
      !path.empty(), Errc::plugin, "there is no plug-in '{}'{} (searched {}; MULLION_PLUGIN_PATH adds folders)", name,
      config::suggestion(name, names()), folders_.empty() ? "nowhere" : fmt::format("{}", fmt::join(folders_, ", ")));
  auto library = std::make_unique<Library>(path);
  MULLION_REQUIRE(library->header().name == name, Errc::plugin,
                  "plug-in {}: the library calls itself '{}'; file and plug-in must have one name, rename the file "
                  "or correct its MULLION_PLUGIN line",
                  path, library->header().name);
  open_.emplace_back(name, std::move(library));
  return *open_.back().second;
}

} // namespace mullion::plugin
