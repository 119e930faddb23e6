// Which nodes of a moving mesh are given their velocity: those of the wall, and those of the rest of the boundary,
// which stay where they are, slide along a flat side or are left to the equation there.
#pragma once

#include "moving_mesh.hpp"

#include <vector>

namespace mullion::moving_mesh {

/// The boundary: faces (edges in the plane) that only one element has, each as its nodes in ascending order.
std::vector<std::vector<Index>> boundary_faces(const MovingMesh& mesh);

/// A side of the box around the mesh, where nodes do not stay.
struct Side {
  int axis = 0;
  bool is_upper = false;
  bool is_free = false; ///< not even its normal component is given: the equation's natural condition
};

/// (dimension x nodes) is this component of this node's velocity given?
using IsGiven = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

struct Constraints {
  IsGiven is_given;
  std::vector<Index> n_faces; ///< of the boundary, on each of the sides
};

/// Nodes of the wall, and of faces on none of the sides, are given as a whole; all others on a side that is not free in
/// the direction normal to it. Inner nodes are free.
///
/// @param wall_nodes  numbers of the wall's nodes in the mesh
/// @param sides       where nodes may move
Constraints constraints(const MovingMesh& mesh, std::span<const Index> wall_nodes, const std::vector<Side>& sides);

} // namespace mullion::moving_mesh
