// What is wrong with a mesh file or a generator's text: where, what was found, what would be right. Kernels know
// neither the SDK nor its errors; the modules that read meshes turn this one into theirs.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace mullion::mesh_files {

class FileError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// The pieces in a row, as a stream prints them.
template <class... Pieces> std::string join(const Pieces&... pieces)
{
  std::ostringstream out;
  (out << ... << pieces);
  return out.str();
}

} // namespace mullion::mesh_files
