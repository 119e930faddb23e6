// The equations whose solution moves the inner nodes of a mesh with its boundary: Laplace's, with a stiffness from
// element to element, and those of linear elasticity. Assembled on the reference mesh and factored once; then each
// motion of the wall is one solution, linear in it, so a wall that comes back brings the whole mesh back.
#pragma once

#include "constraints.hpp"
#include "moving_mesh.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <memory>
#include <vector>

namespace mullion::moving_mesh {

/// 1 + tau_m of each element: small elements are stiff and the large ones take the deformation.
///
///     tau_m = (1 - V_min / V_max) / (V / V_max)                                           masud1997
///
/// 0 on a mesh of equal elements. tau_m is at most 1e4: beyond that one sliver would only spoil the equations'
/// condition.
/// @param measures  V, area or volume of each element [m^2 or m^3]
std::vector<double> masud_hughes_stiffness(const std::vector<double>& measures);

/// (V_max / V)^chi of each element: Young's modulus up to a factor, which does not matter here.
std::vector<double> inverse_measure_stiffness(const std::vector<double>& measures, double chi);

using Sparse = Eigen::SparseMatrix<double>;

/// int k grad u . grad phi over P1 on the elements' parts: (nodes x nodes), one row a node.
/// @param stiffness  k of each element [1]
Sparse laplacian_matrix(const MovingMesh& mesh, const std::vector<double>& stiffness);

/// The stiffness matrix of linear elasticity over P1 on the elements' parts, in the plane for plane strain:
/// (dimension * nodes) squared, the components of a node side by side.
/// @param stiffness  Young's modulus of each element, in any unit
Sparse elasticity_matrix(const MovingMesh& mesh, const std::vector<double>& stiffness, double poisson_ratio);

/// A symmetric system with some unknowns given, factored.
class GivenSystem {
public:
  /// @param matrix    (n x n), symmetric
  /// @param is_given  n: is this unknown given?
  GivenSystem(const Sparse& matrix, const Eigen::Array<bool, Eigen::Dynamic, 1>& is_given);

  /// False if some unknowns hang on no given one, so that nothing decides about them.
  [[nodiscard]] bool is_regular() const { return is_regular_; }

  /// Replace what is not given by the solution.
  void complete(Eigen::Ref<Eigen::VectorXd> values) const;

private:
  std::vector<Eigen::Index> free_, given_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> on_given_; ///< the free rows' entries for given unknowns
  Eigen::SimplicialLDLT<Sparse> factor_;
  bool is_regular_ = true;
};

/// The solver of a mesh's motion: a system for all components together, or one for each.
struct MotionSolver {
  std::vector<std::shared_ptr<const GivenSystem>> systems; ///< components with the same given nodes share one

  [[nodiscard]] bool is_regular() const;
};

/// The components are independent of each other.
MotionSolver solver_by_component(const Sparse& matrix, const IsGiven& is_given);
/// The components depend on each other.
MotionSolver coupled_solver(const Sparse& matrix, const IsGiven& is_given);

/// @param velocity  (dimension x nodes) [m/s], in: the given components; out: all
void complete_motion(const MotionSolver& solver, Eigen::MatrixXd& velocity);

} // namespace mullion::moving_mesh
