// Plug-ins loaded from a copy of their file's bytes at that moment: whoever builds the file anew while a run uses it
// changes nothing, and two builds of one plug-in live side by side. The copies are memory objects, so nothing stays
// behind; hosts open them through /proc/<our pid>/fd/<n>.
#pragma once

#include "plugin/library.hpp"
#include "shm/memory_object.hpp"

#include <memory>
#include <string>
#include <vector>

namespace mullion::plugin {

class PrivateCopies {
public:
  /// The library that the file holds now; its path() is the copy's. The same bytes are copied once.
  /// @throws Error Errc::plugin: no such file, or refused by Library, named as the file
  const Library& open(const std::string& file);

private:
  struct Copy {
    shm::Descriptor object; ///< stays open, refused or not: the loader knows libraries by their path
    shm::Mapping bytes;
    std::unique_ptr<Library> library; ///< null: refused, and why
    std::string refusal;
  };
  static const Library& checked(const Copy& copy);

  std::vector<Copy> copies_;
};

} // namespace mullion::plugin
