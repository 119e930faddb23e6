// Which plug-ins there are: every <name>.so on the plug-in path, found by name without opening the others.
// The path is MULLION_PLUGIN_PATH (colon-separated) and then lib/mullion/plugins beside the executable's bin/.
#pragma once

#include "plugin/library.hpp"

#include <memory>
#include <string>
#include <vector>

namespace mullion::plugin {

class Catalogue {
public:
  /// The folders of this process's plug-in path.
  Catalogue();
  explicit Catalogue(std::vector<std::string> folders) : folders_(std::move(folders)) {}

  /// Names of all libraries on the path, sorted, without opening them.
  [[nodiscard]] std::vector<std::string> names() const;
  [[nodiscard]] const std::vector<std::string>& folders() const { return folders_; }

  /// The path of the plug-in of this name, or "" if there is none.
  [[nodiscard]] std::string find(const std::string& name) const;

  /// Open a plug-in by name (kept open, opened once).
  /// @throws Error Errc::plugin: unknown (with the nearest name), or refused by Library
  const Library& open(const std::string& name);

private:
  std::vector<std::string> folders_;
  std::vector<std::pair<std::string, std::unique_ptr<Library>>> open_;
};

} // namespace mullion::plugin
