#include "mesh_file.hpp"

#include "file_error.hpp"
#include "raw_mesh.hpp"

#include <utility>

namespace mullion::mesh_files {

const Group& find_group(const MeshFile& mesh, const std::string& name, int dimension)
{
  const Group* found = nullptr;
  std::string known;
  for (const auto& group : mesh.groups) {
    known += join(known.empty() ? "" : ", ", '"', group.name, '"');
    if (group.name != name || (dimension >= 0 && group.dimension != dimension)) continue;
    if (found != nullptr)
      throw FileError(join("two groups of the mesh are called \"", name, "\", of dimension ", found->dimension, " and ",
                           group.dimension, "; give one of them another name"));
    found = &group;
  }
  if (found == nullptr)
    throw FileError(join("the mesh has no group \"", name, "\"",
                         dimension >= 0 ? join(" of dimension ", dimension) : std::string(), "; it has ",
                         known.empty() ? "none" : known));
  return *found;
}

MeshFile only(const MeshFile& mesh, const Group& group)
{
  RawMesh raw;
  raw.numbers = mesh.node_numbers;
  raw.coordinates.assign(3 * static_cast<std::size_t>(mesh.nodes.cols()), 0.0);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i)
    for (Eigen::Index k = 0; k < mesh.nodes.rows(); ++k)
      raw.coordinates[static_cast<std::size_t>(3 * i + k)] = mesh.nodes(k, i);
  for (const auto& [block, column] : group.elements) {
    const auto& [shape, connectivity] = mesh.blocks[static_cast<std::size_t>(block)];
    add_element(raw, shape, {connectivity.col(column).data(), static_cast<std::size_t>(connectivity.rows())});
  }
  return finished(std::move(raw), mesh.dimension);
}

MeshFile lifted(MeshFile mesh, int dimension)
{
  const auto before = mesh.nodes.rows();
  if (dimension < before || dimension > 3)
    throw FileError(join("a mesh in ", before, " dimensions cannot be one in ", dimension, "; it can have between ",
                         before, " and 3"));
  mesh.nodes.conservativeResize(dimension, Eigen::NoChange);
  mesh.nodes.bottomRows(dimension - before).setZero();
  mesh.dimension = dimension;
  return mesh;
}

} // namespace mullion::mesh_files
