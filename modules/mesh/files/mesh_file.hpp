// The mesh of a file or a generator as plain data: nodes, blocks of elements of one shape, named groups of elements.
// What is done with it (windows, fields) is not known here.
#pragma once

#include "shapes.hpp"

#include <Eigen/Core>

#include <compare>
#include <cstdint>
#include <string>
#include <vector>

namespace mullion::mesh_files {

using Index = std::int32_t;                                                ///< of a node, a block, an element
using Connectivity = Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>; ///< (nodes x elements), 0-based

/// Elements of one shape.
struct Block {
  Shape shape;
  Connectivity connectivity;
};

/// Which element: column `column` of block `block`.
struct Element {
  Index block = 0, column = 0;
  auto operator<=>(const Element&) const = default;
};

/// A named set of elements of one dimension, say a boundary. An element may be in several groups.
struct Group {
  std::string name;
  int dimension = 0; ///< of its elements: 0 points … 3 volumes
  std::vector<Element> elements;
};

struct MeshFile {
  int dimension = 0;         ///< of space, 1 to 3
  Eigen::MatrixXd nodes;     ///< (dimension x n_nodes) [m]; each is a node of some element
  std::vector<Block> blocks; ///< one a shape, none of them empty
  std::vector<Group> groups;
  std::vector<std::int64_t> node_numbers; ///< of each node: its number in the file (MSH: its tag, VTK: 0-based)
};

/// The group of this name.
/// @param dimension  of its elements, where two groups have one name; -1: any
/// @throws FileError with the names that there are
const Group& find_group(const MeshFile& mesh, const std::string& name, int dimension = -1);

/// The elements of one group, and their nodes, as a mesh without groups. Elements keep their order within each shape.
MeshFile only(const MeshFile& mesh, const Group& group);

/// The same mesh in a space of more dimensions, the new coordinates 0.
/// @throws FileError if it has more dimensions than that
MeshFile lifted(MeshFile mesh, int dimension);

} // namespace mullion::mesh_files
