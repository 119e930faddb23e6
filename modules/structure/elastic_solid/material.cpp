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

Eigen::Matrix<double, 6, 1> full_stress(const Material& material, const Eigen::VectorXd& stress)
{
  if (stress.size() == 6) return stress;
  const double zz = material.plane == Plane::strain ? material.poisson_ratio * (stress[0] + stress[1]) : 0.0;
  Eigen::Matrix<double, 6, 1> all;
  all << stress[0], stress[1], zz, stress[2], 0.0, 0.0;
  return all;
}

double von_mises(const Eigen::Matrix<double, 6, 1>& s)
{
  const double xy = s[0] - s[1], yz = s[1] - s[2], zx = s[2] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5]));
}

} // namespace mullion::elastic_solid
