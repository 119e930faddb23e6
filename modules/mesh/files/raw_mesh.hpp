// A mesh while it is being read or generated: nodes and elements in any order, with nodes that no element uses.
// finished() makes the MeshFile of it.
#pragma once

#include "mesh_file.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mullion::mesh_files {

struct RawMesh {
  std::vector<double> coordinates;                       ///< 3 a node
  std::vector<std::int64_t> numbers;                     ///< of the nodes, as in the file
  std::array<std::vector<Index>, n_shapes> connectivity; ///< by shape, of nodes in the order above
  std::vector<Shape> shapes;                             ///< that there are, in the order of appearance
  std::vector<Group> groups;                             ///< an element's block: the number of its shape
};

inline std::size_t n_nodes(const RawMesh& raw) { return raw.numbers.size(); }

/// @return where the element is, for groups
/// @pre    the nodes are within the mesh
Element add_element(RawMesh& raw, Shape shape, std::span<const Index> nodes);

/// Put the element into the group of this name and the element's dimension, which is made if there is none.
void add_to_group(RawMesh& raw, const std::string& name, Element element);

/// Without the nodes that no element uses.
/// @param dimension  of space; 0: the smallest whose further coordinates are all exactly 0
/// @throws FileError where there is no element, a coordinate is not finite, or one beyond `dimension` is not 0
MeshFile finished(RawMesh raw, int dimension);

} // namespace mullion::mesh_files
