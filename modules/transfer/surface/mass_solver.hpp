// Conjugate gradients for a mass matrix too large to be factorised: all components of a field in one pass over the
// matrix, and the same bits wherever it runs.
#pragma once

#include "operator_sum.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace mullion::surface {

/// A symmetric matrix with a positive diagonal D, scaled to D^-1/2 M D^-1/2 = I + U + U^T, and U by rows.
struct ScaledMass {
  Eigen::VectorXd scale;               ///< 1/sqrt of the diagonal; 0 in pinned rows
  std::vector<std::int64_t> row_begin; ///< n + 1
  std::vector<std::int32_t> columns;
  std::vector<double> values;
};

/// @param is_pinned  rows and columns that do not count
[[nodiscard]] ScaledMass scaled_mass(const Operator& matrix, const std::vector<bool>& is_pinned);

/// Solves M X = R for each component; pinned entries become zero.
///
/// Preconditioned by a symmetric Gauss-Seidel step, P = (I + U^T)(I + U), after Eisenstat 1981: on the matrix
/// (I + U^T)^-1 (I + U + U^T) (I + U)^-1 = (I + U)^-1 + (I + U^T)^-1 (I - (I + U)^-1), so that a step costs as much as
/// a product. For a mass matrix P is so good that a dozen steps reach round-off, whatever the mesh width.
///
/// @param right      (components x n), one to three components
/// @param solution   (components x n)
/// @return           false: not at round-off after 200 steps, the matrix is not positive or the right hand side not
///                   finite; the solution is NaN then
[[nodiscard]] bool conjugate_gradients(const ScaledMass& mass, const Eigen::Ref<const Eigen::MatrixXd>& right,
                                       Eigen::MatrixXd& solution);

} // namespace mullion::surface
