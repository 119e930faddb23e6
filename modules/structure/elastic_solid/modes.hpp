// Modal analysis: the lowest frequencies of a solid and the shapes that go with them.
#pragma once

#include "time_integration.hpp"

#include <string>

namespace mullion::elastic_solid {

/// K phi = omega^2 M phi on the free degrees of freedom.
struct Modes {
  Eigen::VectorXd angular_frequencies; ///< ascending; 0 for a rigid motion [rad/s]
  Eigen::MatrixXd shapes;              ///< (n_dofs x n_modes), phi^T M phi = 1 [1/sqrt(kg)], 0 where not free
  std::string complaint;               ///< what went wrong; then there are no modes
};

/// The lowest modes, by Lanczos' method with shift and invert; small problems whole.
///
/// The same system gives the same bits. The sign is such that the largest component is positive; of components that
/// are equally large but for round-off the first one.
/// @param n_modes  at most the number of free degrees of freedom, else a complaint
[[nodiscard]] Modes lowest_modes(const System& system, Eigen::Index n_modes);

/// q_k = phi_k^T M u [m sqrt(kg)].
[[nodiscard]] Eigen::VectorXd modal_coordinates(const Modes& modes, const SparseMatrix& mass,
                                                const Eigen::VectorXd& displacement);

} // namespace mullion::elastic_solid
