// Places and weights for integrals over the reference faces: Gauss-Legendre on a line, tensor products on a
// quadrilateral, and rules for triangles.
#pragma once

#include <cstddef>
#include <vector>

namespace mullion::surface {

/// A place in a reference face and its weight; the weights sum to the face's reference measure (1, or 1/2 of a
/// triangle).
struct RulePoint {
  double xi[2];
  double weight;
};

using Rule = std::vector<RulePoint>;

/// Gauss-Legendre on [0, 1]: n points, exact to degree 2 n - 1. The places rise, the weights are symmetric to the bit.
///
/// @pre  1 <= n <= 64
[[nodiscard]] Rule gauss_rule(int n);

/// n points a direction on a face with this number of nodes: gauss_rule(n) on a line and its square on a
/// quadrilateral; on a triangle the centroid (n = 1), the three points inside that are exact to degree 2 (n = 2), and
/// from n = 3 the square collapsed into the triangle, exact to degree 2 n - 2.
[[nodiscard]] Rule face_rule(std::size_t n_nodes, int n);

/// face_rule(n_nodes, 2), which integrates products of shape functions exactly; kept, for it is asked for on every
/// face.
[[nodiscard]] const Rule& mass_rule(std::size_t n_nodes);

/// Six points on a triangle, exact to degree 4 (Dunavant 1985).
[[nodiscard]] Rule triangle_rule_of_degree_4();

} // namespace mullion::surface
