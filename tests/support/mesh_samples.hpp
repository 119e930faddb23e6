// What the tests of the mesh files share: files of other programs, and ways to compare and check meshes.
#pragma once

#include "files/mesh_file.hpp"

#include <Eigen/Geometry>

#include <cstdint>
#include <fstream>
#include <iterator>
#include <string>

namespace mullion::testing {

inline std::string mesh_sample_path(const std::string& name)
{
  return std::string(MULLION_SOURCE_DIR) + "/tests/unit/mesh/data/" + name;
}

inline std::string mesh_sample(const std::string& name)
{
  std::ifstream in(mesh_sample_path(name), std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The connectivity of one shape; empty without it.
inline mesh_files::Connectivity elements_of(const mesh_files::MeshFile& mesh, mesh_files::Shape shape)
{
  for (const auto& block : mesh.blocks)
    if (block.shape == shape) return block.connectivity;
  return {};
}

/// Same nodes to the bit, blocks and groups; the numbers of the nodes don't count.
inline bool is_same(const mesh_files::MeshFile& a, const mesh_files::MeshFile& b)
{
  bool is_same = a.dimension == b.dimension && a.nodes == b.nodes && a.blocks.size() == b.blocks.size() &&
                 a.groups.size() == b.groups.size();
  for (std::size_t i = 0; is_same && i < a.blocks.size(); ++i)
    is_same = a.blocks[i].shape == b.blocks[i].shape && a.blocks[i].connectivity == b.blocks[i].connectivity;
  for (std::size_t i = 0; is_same && i < a.groups.size(); ++i)
    is_same = a.groups[i].name == b.groups[i].name && a.groups[i].dimension == b.groups[i].dimension &&
              a.groups[i].elements == b.groups[i].elements;
  return is_same;
}

/// Everything refers to something that is there.
inline bool is_sound(const mesh_files::MeshFile& mesh)
{
  if (mesh.blocks.empty() || mesh.nodes.rows() != mesh.dimension || !mesh.nodes.allFinite()) return false;
  if (mesh.node_numbers.size() != static_cast<std::size_t>(mesh.nodes.cols())) return false;
  for (const auto& block : mesh.blocks)
    if (block.connectivity.size() == 0 || block.connectivity.minCoeff() < 0 ||
        block.connectivity.maxCoeff() >= mesh.nodes.cols() ||
        block.connectivity.rows() != mesh_files::facts(block.shape).n_nodes)
      return false;
  for (const auto& group : mesh.groups)
    for (const auto& [block, column] : group.elements)
      if (block < 0 || block >= static_cast<int>(mesh.blocks.size()) || column < 0 ||
          column >= mesh.blocks[static_cast<std::size_t>(block)].connectivity.cols())
        return false;
  return true;
}

/// Integral of the normal over a group of lines in the plane or of faces in space: their directed length or area.
inline Eigen::Vector3d directed_area(const mesh_files::MeshFile& mesh, const mesh_files::Group& group)
{
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [b, column] : group.elements) {
    const auto& connectivity = mesh.blocks[static_cast<std::size_t>(b)].connectivity;
    const auto x = [&](Eigen::Index k) {
      Eigen::Vector3d point = Eigen::Vector3d::Zero();
      point.head(mesh.dimension) = mesh.nodes.col(connectivity(k, column));
      return point;
    };
    if (connectivity.rows() == 2) sum += (x(1) - x(0)).cross(Eigen::Vector3d::UnitZ());
    else if (connectivity.rows() == 3) sum += 0.5 * (x(1) - x(0)).cross(x(2) - x(0));
    else sum += 0.5 * (x(2) - x(0)).cross(x(3) - x(1));
  }
  return sum;
}

} // namespace mullion::testing
