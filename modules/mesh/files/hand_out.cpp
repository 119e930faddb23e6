// Whole texts to a descriptor.
#include "hand_out.hpp"

#include "file_error.hpp"
#include "msh.hpp"
#include "read.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <string_view>
#include <unistd.h>

namespace mullion::mesh_files {
namespace {

void write_all(double descriptor, std::string_view bytes)
{
  if (!(descriptor >= 0.0) || descriptor != std::floor(descriptor) || descriptor > 1e9)
    throw FileError(join("a mesh is written to the number of an open file of the same process, not to ", descriptor));
  const int file = static_cast<int>(descriptor);
  while (!bytes.empty()) {
    const auto n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0)
      throw FileError(join("the mesh cannot be written to file ", file, " of this process (", std::strerror(errno),
                           "); expected is the number of a file that it has open"));
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
}

} // namespace

double write_mesh_to(const std::string& text, int dimension, double descriptor)
{
  const auto bytes = msh_text(read_or_generate(text, dimension));
  write_all(descriptor, bytes);
  return static_cast<double>(bytes.size());
}

double list_boundaries_to(const std::string& text, int dimension, double descriptor)
{
  const auto mesh = read_or_generate(text, dimension);
  int largest = 0;
  for (const auto& block : mesh.blocks) largest = std::max(largest, facts(block.shape).dimension);
  std::string lines;
  int n = 0;
  for (const auto& group : mesh.groups) {
    if (group.dimension != largest - 1) continue;
    lines += join(group.elements.size(), ' ', group.name, '\n');
    ++n;
  }
  write_all(descriptor, lines);
  return n;
}

} // namespace mullion::mesh_files
