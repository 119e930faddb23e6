// Shape functions and quadrature of the element shapes that a solid and its surface consist of.
#pragma once

#include "files/shapes.hpp"

#include <Eigen/Core>

#include <vector>

namespace mullion::elastic_solid {

using mesh_files::Shape;

/// Shape functions at a point of the reference element: [-1, 1]^d for lines, quadrilaterals and hexahedra, the unit
/// simplex for triangles and tetrahedra.
struct ShapeValues {
  Eigen::VectorXd values;    ///< N_a, n_nodes
  Eigen::MatrixXd gradients; ///< dN_a/dxi_k, (n_nodes x d)
};

/// @param xi  d reference coordinates
[[nodiscard]] ShapeValues shape_values(Shape shape, const Eigen::VectorXd& xi);

struct QuadraturePoint {
  Eigen::VectorXd xi;
  double weight = 0.0;
};

/// Integrates N_a N_b of a parallelogram (parallelepiped, simplex) exactly: two Gauss points a direction, three
/// points in a triangle, four in a tetrahedron.
[[nodiscard]] const std::vector<QuadraturePoint>& quadrature(Shape shape);

/// Reference coordinates of the nodes, one a column.
[[nodiscard]] Eigen::MatrixXd reference_nodes(Shape shape);

/// Reference coordinates of the centre.
[[nodiscard]] Eigen::VectorXd reference_centre(Shape shape);

} // namespace mullion::elastic_solid
