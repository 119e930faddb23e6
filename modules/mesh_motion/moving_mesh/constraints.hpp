// Which nodes of a moving mesh are given their velocity: those of the wall, and those of the rest of the boundary,
// which stay where they are or slide along a flat side.
#pragma once

#include "moving_mesh.hpp"

#include <vector>

namespace mullion::moving_mesh {

/// The boundary: faces (edges in the plane) that only one element has, each as its nodes in ascending order.
std::vector<std::vector<Index>> boundary_faces(const MovingMesh& mesh);

/// A side of the box around the mesh.
struct Side {
  int axis = 0;
  bool is_upper = false;
};

/// (dimension x nodes) is this component of this node's velocity given?
using IsGiven = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;

struct Constraints {
  IsGiven is_given;
  std::vector<Index> n_faces; ///< of the boundary, on each sliding side
};

/// Nodes of the wall, and of faces on no sliding side, are given as a whole; all others on a sliding side in the
/// direction normal to it. Inner nodes are free.
///
/// @param wall_nodes  numbers of the wall's nodes in the mesh
/// @param sliding     sides along which nodes may move
Constraints constraints(const MovingMesh& mesh, std::span<const Index> wall_nodes, const std::vector<Side>& sliding);

} // namespace mullion::moving_mesh
