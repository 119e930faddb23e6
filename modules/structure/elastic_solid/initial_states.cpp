#include "initial_states.hpp"

#include <cmath>

namespace mullion::elastic_solid {

Eigen::VectorXd pressure_shape(const FreeSolver& stiffness, const Eigen::MatrixXd& normals, Eigen::Index node,
                               const Eigen::VectorXd& along, double amplitude)
{
  const Eigen::VectorXd load = -normals.reshaped(); // of a unit pressure, which pushes inward
  const Eigen::VectorXd shape = stiffness.solve(load);
  const double there = shape.segment(node * normals.rows(), normals.rows()).dot(along);
  // A node that is held, or on a line of symmetry: no factor would do.
  if (!(std::abs(there) > 1e-9 * shape.cwiseAbs().maxCoeff())) return Eigen::VectorXd::Zero(shape.size());
  return amplitude / there * shape;
}

Eigen::VectorXd scaled_shape(const Eigen::VectorXd& shape, double amplitude)
{
  return amplitude / shape.cwiseAbs().maxCoeff() * shape;
}

} // namespace mullion::elastic_solid
