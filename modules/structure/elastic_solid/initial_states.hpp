// Shapes in which a solid can start.
#pragma once

#include "boundary.hpp"
#include "time_integration.hpp"

namespace mullion::elastic_solid {

/// How a uniform pressure on a surface bends the body: the static displacement, scaled.
///
/// @param stiffness  solver of K
/// @param normals    nodal_normals() of the surface, of all nodes (dimension x n_nodes)
/// @param node       where, and @param along  in which unit direction the displacement is `amplitude` [m]
/// @return n_dofs; all zero where the pressure does not move that node
[[nodiscard]] Eigen::VectorXd pressure_shape(const FreeSolver& stiffness, const Eigen::MatrixXd& normals,
                                             Eigen::Index node, const Eigen::VectorXd& along, double amplitude);

/// A shape scaled such that its largest component is `amplitude` [m].
[[nodiscard]] Eigen::VectorXd scaled_shape(const Eigen::VectorXd& shape, double amplitude);

} // namespace mullion::elastic_solid
