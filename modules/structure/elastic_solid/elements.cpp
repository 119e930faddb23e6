#include "elements.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

namespace mullion::elastic_solid {
namespace {

/// Which two directions the Voigt components 3, 4, 5 (in 2D: 2) belong to.
constexpr std::array<std::pair<Eigen::Index, Eigen::Index>, 3> shear_pairs = {{{0, 1}, {1, 2}, {2, 0}}};

Eigen::Index n_strains(Eigen::Index d) { return d == 2 ? 3 : 6; }

/// B: strains (xx, yy, 2xy) or (xx, yy, zz, 2xy, 2yz, 2zx) of the nodal displacements.
/// @param gradients  dN_a/dx, (n x d)
Eigen::MatrixXd strain_matrix(const Eigen::MatrixXd& gradients)
{
  const auto n = gradients.rows(), d = gradients.cols();
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n_strains(d), n * d);
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index i = 0; i < d; ++i) b(i, a * d + i) = gradients(a, i);
    for (Eigen::Index s = d; s < b.rows(); ++s) {
      const auto [i, k] = shear_pairs[static_cast<std::size_t>(s - d)];
      b(s, a * d + i) = gradients(a, k);
      b(s, a * d + k) = gradients(a, i);
    }
  }
  return b;
}

/// T of eps = G eps_ref G^T in Voigt's notation. @param g  dxi_k/dx_i, (d x d)
Eigen::MatrixXd strain_transformation(const Eigen::MatrixXd& g)
{
  const auto d = g.rows(), n = n_strains(d);
  Eigen::MatrixXd t(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    Eigen::MatrixXd strain = Eigen::MatrixXd::Zero(d, d);
    if (column < d) strain(column, column) = 1.0;
    else {
      const auto [i, k] = shear_pairs[static_cast<std::size_t>(column - d)];
      strain(i, k) = strain(k, i) = 0.5;
    }
    const Eigen::MatrixXd image = g * strain * g.transpose();
    for (Eigen::Index i = 0; i < d; ++i) t(i, column) = image(i, i);
    for (Eigen::Index s = d; s < n; ++s) {
      const auto [i, k] = shear_pairs[static_cast<std::size_t>(s - d)];
      t(s, column) = 2.0 * image(i, k);
    }
  }
  return t;
}

/// E(xi): each normal strain along its own coordinate, each shear strain along both of its coordinates.
Eigen::MatrixXd enhanced_modes(const Eigen::VectorXd& xi)
{
  const auto d = xi.size(), n = n_strains(d);
  Eigen::MatrixXd e = Eigen::MatrixXd::Zero(n, d + 2 * (n - d));
  for (Eigen::Index i = 0; i < d; ++i) e(i, i) = xi[i];
  for (Eigen::Index s = d; s < n; ++s) {
    const auto [i, k] = shear_pairs[static_cast<std::size_t>(s - d)];
    e(s, d + 2 * (s - d)) = xi[i];
    e(s, d + 2 * (s - d) + 1) = xi[k];
  }
  return e;
}

} // namespace

bool is_solid_shape(Shape shape, int dimension)
{
  if (dimension == 2) return shape == Shape::triangle3 || shape == Shape::quadrilateral4;
  return dimension == 3 && (shape == Shape::tetrahedron4 || shape == Shape::hexahedron8);
}

double smallest_jacobian(Shape shape, const Eigen::MatrixXd& nodes)
{
  double smallest = std::numeric_limits<double>::infinity();
  const auto look_at = [&](const Eigen::VectorXd& xi) {
    smallest = std::min(smallest, (nodes * shape_values(shape, xi).gradients).determinant());
  };
  for (const auto& point : quadrature(shape)) look_at(point.xi);
  const auto corners = reference_nodes(shape);
  for (Eigen::Index a = 0; a < corners.cols(); ++a) look_at(corners.col(a));
  return smallest;
}

double element_volume(Shape shape, const Eigen::MatrixXd& nodes)
{
  double volume = 0.0;
  for (const auto& point : quadrature(shape))
    volume += point.weight * (nodes * shape_values(shape, point.xi).gradients).determinant();
  return volume;
}

Eigen::MatrixXd element_stiffness(Shape shape, Formulation formulation, const Eigen::MatrixXd& nodes,
                                  const Eigen::MatrixXd& elasticity)
{
  const auto d = nodes.rows(), n = nodes.cols() * d;
  const bool is_enhanced =
      formulation == Formulation::enhanced && (shape == Shape::quadrilateral4 || shape == Shape::hexahedron8);
  const Eigen::MatrixXd centre = nodes * shape_values(shape, reference_centre(shape)).gradients; // J_0
  const Eigen::MatrixXd t0 = strain_transformation(centre.inverse().transpose());
  const double j0 = centre.determinant();
  const auto n_modes = d + 2 * (n_strains(d) - d);

  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n), l = Eigen::MatrixXd::Zero(n_modes, n),
                  dd = Eigen::MatrixXd::Zero(n_modes, n_modes);
  for (const auto& point : quadrature(shape)) {
    const auto s = shape_values(shape, point.xi);
    const Eigen::MatrixXd jacobian = nodes * s.gradients;
    const double j = jacobian.determinant(), dv = point.weight * j;
    const Eigen::MatrixXd b = strain_matrix(s.gradients * jacobian.inverse());
    const Eigen::MatrixXd cb = elasticity * b;
    k += dv * b.transpose() * cb;
    if (!is_enhanced) continue;
    const Eigen::MatrixXd m = (j0 / j) * t0 * enhanced_modes(point.xi);
    l += dv * m.transpose() * cb;
    dd += dv * m.transpose() * elasticity * m;
  }
  if (is_enhanced) k -= l.transpose() * dd.ldlt().solve(l);
  return 0.5 * (k + k.transpose()); // symmetric to the bit
}

Eigen::MatrixXd element_mass(Shape shape, const Eigen::MatrixXd& nodes, double density)
{
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(nodes.cols(), nodes.cols());
  for (const auto& point : quadrature(shape)) {
    const auto s = shape_values(shape, point.xi);
    mass += (density * point.weight * (nodes * s.gradients).determinant()) * s.values * s.values.transpose();
  }
  return mass;
}

Eigen::MatrixXd centre_stress_matrix(Shape shape, const Eigen::MatrixXd& nodes, const Eigen::MatrixXd& elasticity)
{
  const auto s = shape_values(shape, reference_centre(shape));
  return elasticity * strain_matrix(s.gradients * (nodes * s.gradients).inverse());
}

} // namespace mullion::elastic_solid
