// The finite elements of the solid: stiffness, mass and stress of one element. Triangles, quadrilaterals, tetrahedra,
// hexahedra; the last of both kinds with enhanced strains on request. No mesh, no assembly.
#pragma once

#include "shapes.hpp"

#include <Eigen/Core>

namespace mullion::elastic_solid {

/// How quadrilaterals and hexahedra approximate strains. Simplices have the standard ones only.
enum class Formulation {
  standard, ///< those of the displacement: locks in bending, the more the thinner the element
  enhanced  ///< Q4E4 and H8E9: with 4 or 9 strains of the element's own, condensed; bends without locking
};

/// Is it a shape that a solid of this dimension consists of?
[[nodiscard]] bool is_solid_shape(Shape shape, int dimension);

/// The smallest det J at the quadrature points and the nodes [m^d]: not positive for an element that is inverted,
/// degenerate or has a corner of 180 degrees or more. @param nodes  (d x n_nodes) [m]
[[nodiscard]] double smallest_jacobian(Shape shape, const Eigen::MatrixXd& nodes);

/// Area [m^2] or volume [m^3].
[[nodiscard]] double element_volume(Shape shape, const Eigen::MatrixXd& nodes);

/// K = int B^T C B dV, degrees of freedom node by node (u_x, u_y of the first, …) [N/m per m of depth in 2D].
///
/// Enhanced (Simo & Rifai 1990, mapping of Taylor, Beresford & Wilson 1976): the strain is B d + M alpha with
///
///     M(xi) = (j_0/j) T_0 E(xi),  E = columns xi, eta, … in the normal strains and in each shear strain
///
/// T_0 the transformation of strains by the Jacobian at the centre, j = det J. As int M dV = 0 every patch test
/// passes, on any mesh. alpha = -D^-1 L d is eliminated: K = K_dd - L^T D^-1 L, L = int M^T C B, D = int M^T C M.
///
/// @param nodes       (d x n_nodes) [m]
/// @param elasticity  C [Pa]
/// @pre  smallest_jacobian() > 0
[[nodiscard]] Eigen::MatrixXd element_stiffness(Shape shape, Formulation formulation, const Eigen::MatrixXd& nodes,
                                                const Eigen::MatrixXd& elasticity);

/// Consistent mass m_ab = int rho N_a N_b dV, one component, (n_nodes x n_nodes) [kg per m of depth in 2D].
[[nodiscard]] Eigen::MatrixXd element_mass(Shape shape, const Eigen::MatrixXd& nodes, double density);

/// Stress at the element's centre of the nodal displacements, C B [Pa/m]; enhanced strains vanish there.
[[nodiscard]] Eigen::MatrixXd centre_stress_matrix(Shape shape, const Eigen::MatrixXd& nodes,
                                                   const Eigen::MatrixXd& elasticity);

} // namespace mullion::elastic_solid
