// How good the elements of a moved mesh still are, and whether one is folded.
#pragma once

#include "moving_mesh.hpp"

#include <vector>

namespace mullion::moving_mesh {

struct Quality {
  double min_area_ratio = 1.0;   ///< q_A: smallest area or volume by the element's own in the reference mesh [1]
  double min_shape = 1.0;        ///< q_S: worst shape of an element [1], 1 the best, 0 and below folded
  Index smallest = 0, worst = 0; ///< the elements that these belong to
  bool is_folded = false;        ///< has an element a part that is turned over?
  Index folded = 0;              ///< the one that is folded most, and …
  double folded_ratio = 1.0;     ///< … its part's measure by that of the whole element in the reference mesh [1]
};

/// Shape of an element: for triangles 4 sqrt(3) A / sum l^2, for tetrahedra 72 sqrt(3) V / (sum l^2)^1.5, l the lengths
/// of the edges; for all others the smallest of the scaled Jacobians at the corners, the determinant of the unit
/// vectors along the edges there (at the corners of a pyramid's base). 1 for regular simplices, squares and cubes.
double shape_of_element(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates, Index e);

/// An element is folded where one of its parts (see Parts) has no positive measure: for a quadrilateral that is a
/// corner that is no longer convex.
/// @param reference  measures of the elements in the reference mesh [m^2 or m^3]
Quality quality_of(const MovingMesh& mesh, const std::vector<double>& reference, const Eigen::MatrixXd& coordinates);

} // namespace mullion::moving_mesh
