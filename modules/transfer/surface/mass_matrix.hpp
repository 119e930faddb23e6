// A mass matrix and its solver: what turns loads into a traction, and adjoint loads into a motion.
#pragma once

#include "mass_solver.hpp"
#include "operators.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <cstdint>
#include <memory>
#include <vector>

namespace mullion::surface {

/// M t = R, with M symmetric and positive on the nodes that it knows. Plain data behind a pointer: it may be moved.
struct MassMatrix {
  Operator matrix;
  Eigen::VectorXd row_sums;         ///< [m or m^2]
  std::vector<std::int32_t> pinned; ///< nodes without mass, ascending: solve() and recover() give them zero
  std::unique_ptr<Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>> factors; ///< up to largest_factorised nodes
  ScaledMass scaled;                                                           ///< above, for conjugate gradients
  bool is_solvable = false; ///< all pivots are positive, or a trial came to an end
};

/// Up to here a mass matrix is factorised; the factors of a surface grow faster than the surface, so above conjugate
/// gradients take over. A matrix with which a trial of them fails is factorised all the same.
inline constexpr std::int64_t largest_factorised = 20'000;

/// Prepares a mass matrix for solve(). Nodes whose diagonal is below 1e-14 of the largest one have no mass (they lie
/// beyond the other surface): they are pinned to zero.
[[nodiscard]] MassMatrix mass_matrix(Operator matrix);

/// M^-1 R for each component.
///
/// @param loads  (components x nodes)
/// @pre  is_solvable
[[nodiscard]] Field solve(const MassMatrix& mass, const FieldView& loads);

/// How nodal traction is recovered from loads.
enum class Recovery {
  consistent, ///< M t = R: the best fit, exact for what the target's space holds; may overshoot at jumps
  lumped      ///< t_j = R_j / sum_k M_jk: positive, exact for constants, smooths by O(h^2)
};

/// Nodal traction [Pa] from loads [N] on the target: t_s = M_s^-1 R.
///
/// With the mass on the metric of the load operator a constant traction comes out exactly, whatever the gap; with the
/// native mass up to the ratio of the two surfaces' lengths or areas.
///
/// @pre  is_solvable, for consistent
[[nodiscard]] Field recover(const MassMatrix& target_mass, const FieldView& loads, Recovery recovery);

/// v_f = M_f^-1 B^T v_s: the motion of the source that makes the work of both sides equal,
/// R_s . v_s = (M_f t_f) . v_f for R_s = B t_f.
///
/// @param load_operator  B of a nodal source
/// @param source_mass    M_f; rigid translations are exact if B^T 1 = M_f 1, as on the metric of B
[[nodiscard]] Field adjoint_motion(const Operator& load_operator, const MassMatrix& source_mass,
                                   const FieldView& target_motion);

/// The traction of faces from their forces: t_e = F_e / A_e [Pa].
///
/// @param face_forces  (components x faces) [N]; the force of a face without area does not arrive
[[nodiscard]] Field traction_of_face_forces(const SurfaceMesh& mesh, const FieldView& face_forces);

} // namespace mullion::surface
