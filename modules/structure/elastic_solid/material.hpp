// Hooke's law in Voigt's notation. In the plane the strains are (xx, yy, 2xy), in space (xx, yy, zz, 2xy, 2yz, 2zx).
#pragma once

#include <Eigen/Core>

namespace mullion::elastic_solid {

/// What a two-dimensional solid is: a thin plate, free to grow thicker, or a slice of a long body that cannot.
enum class Plane { stress, strain };

/// An isotropic, linear elastic material.
struct Material {
  double youngs_modulus = 1.0; ///< E [Pa]
  double poisson_ratio = 0.0;  ///< nu, in (-1, 0.5)
  double density = 1.0;        ///< rho, per reference volume [kg/m^3]
  Plane plane = Plane::stress; ///< in 2D
};

/// C of sigma = C eps, (3 x 3) in 2D, (6 x 6) in 3D [Pa].
///
///     plane stress  E/(1 - nu^2) [1 nu 0; nu 1 0; 0 0 (1 - nu)/2]
///     plane strain and 3D: lambda = E nu/((1 + nu)(1 - 2 nu)), mu = E/(2 (1 + nu))
[[nodiscard]] Eigen::MatrixXd elasticity(const Material& material, int dimension);

/// All six stresses (xx, yy, zz, xy, yz, zx) from those of `elasticity`, as a matrix: in plane strain zz = nu (xx +
/// yy).
[[nodiscard]] Eigen::MatrixXd full_stress_matrix(const Material& material, int dimension);

/// Von Mises' equivalent stress sqrt(3/2 s : s), s the deviator [Pa].
[[nodiscard]] double von_mises(const Eigen::Matrix<double, 6, 1>& stress);

} // namespace mullion::elastic_solid
