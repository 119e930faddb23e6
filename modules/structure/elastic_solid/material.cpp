#include "material.hpp"

#include <cmath>

namespace mullion::elastic_solid {

Eigen::MatrixXd elasticity(const Material& material, int dimension)
{
  const double nu = material.poisson_ratio, shear = material.youngs_modulus / (2.0 * (1.0 + nu));
  const bool is_plane_stress = dimension == 2 && material.plane == Plane::stress;
  const double lambda =
      is_plane_stress ? 2.0 * shear * nu / (1.0 - nu) : 2.0 * shear * nu / (1.0 - 2.0 * nu); // of the plane
  const Eigen::Index d = dimension, n = d == 2 ? 3 : 6;
  Eigen::MatrixXd c = Eigen::MatrixXd::Zero(n, n);
  c.topLeftCorner(d, d).setConstant(lambda);
  for (Eigen::Index i = 0; i < d; ++i) c(i, i) += 2.0 * shear;
  for (Eigen::Index i = d; i < n; ++i) c(i, i) = shear;
  return c;
}

Eigen::MatrixXd full_stress_matrix(const Material& material, int dimension)
{
  if (dimension == 3) return Eigen::MatrixXd::Identity(6, 6);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(6, 3);
  all(0, 0) = all(1, 1) = all(3, 2) = 1.0;
  if (material.plane == Plane::strain) all(2, 0) = all(2, 1) = material.poisson_ratio;
  return all;
}

double von_mises(const Eigen::Matrix<double, 6, 1>& s)
{
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

} // namespace mullion::elastic_solid
