// One element: patch tests, rank, mass, and the enhanced quadrilateral against the hybrid one of Pian and Sumihara.
#include "elastic_solid/elements.hpp"
#include "elastic_solid/material.hpp"
#include "support/solid_meshes.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <cmath>

using namespace mullion::elastic_solid;
using namespace mullion::testing;
namespace mesh_files = mullion::mesh_files;

namespace {

const Shape all_shapes[] = {Shape::triangle3, Shape::quadrilateral4, Shape::tetrahedron4, Shape::hexahedron8};
const Formulation formulations[] = {Formulation::standard, Formulation::enhanced};

/// No two sides parallel.
Eigen::MatrixXd distorted(Shape shape)
{
  Eigen::MatrixXd x = reference_nodes(shape);
  for (Eigen::Index a = 0; a < x.cols(); ++a)
    for (Eigen::Index i = 0; i < x.rows(); ++i)
      x(i, a) += 0.2 * std::sin(1.3 * static_cast<double>(a) + 2.1 * static_cast<double>(i)) +
                 0.1 * static_cast<double>(i) * x(0, a);
  return x;
}

/// The five-parameter hybrid element: stresses constant, and one in each direction linear along the other.
Eigen::MatrixXd pian_sumihara(const Eigen::MatrixXd& nodes, const Eigen::MatrixXd& elasticity)
{
  const auto corners = reference_nodes(Shape::quadrilateral4);
  const Eigen::Vector2d a1 = 0.25 * nodes * corners.row(0).transpose(), a3 = 0.25 * nodes * corners.row(1).transpose();
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(5, 5), g = Eigen::MatrixXd::Zero(5, 8);
  const Eigen::MatrixXd compliance = elasticity.inverse();
  for (const auto& point : quadrature(Shape::quadrilateral4)) {
    const auto s = shape_values(Shape::quadrilateral4, point.xi);
    const Eigen::MatrixXd jacobian = nodes * s.gradients, gradients = s.gradients * jacobian.inverse();
    Eigen::MatrixXd p = Eigen::MatrixXd::Zero(3, 5), b = Eigen::MatrixXd::Zero(3, 8);
    p.leftCols(3).setIdentity();
    p.col(3) = point.xi[1] * Eigen::Vector3d(a1[0] * a1[0], a1[1] * a1[1], a1[0] * a1[1]);
    p.col(4) = point.xi[0] * Eigen::Vector3d(a3[0] * a3[0], a3[1] * a3[1], a3[0] * a3[1]);
    for (Eigen::Index a = 0; a < 4; ++a) {
      b(0, 2 * a) = b(2, 2 * a + 1) = gradients(a, 0);
      b(1, 2 * a + 1) = b(2, 2 * a) = gradients(a, 1);
    }
    const double dv = point.weight * jacobian.determinant();
    h += dv * p.transpose() * compliance * p;
    g += dv * p.transpose() * b;
  }
  return g.transpose() * h.inverse() * g;
}

} // namespace

TEST_CASE("patch test: on distorted meshes a linear displacement has constant stress and no forces inside")
{
  for (const auto shape : all_shapes)
    for (const auto formulation : formulations)
      for (const auto plane : {Plane::stress, Plane::strain}) {
        CAPTURE(mesh_files::facts(shape).name);
        auto solid = patch(shape);
        solid.material = {.youngs_modulus = 3.0, .poisson_ratio = 0.3, .plane = plane};
        solid.formulation = formulation;
        const Eigen::Index d = solid.dimension();
        Eigen::MatrixXd gradient(d, d); // du_i/dx_k
        for (Eigen::Index i = 0; i < d; ++i)
          for (Eigen::Index k = 0; k < d; ++k) gradient(i, k) = std::sin(1.0 + 2.0 * static_cast<double>(3 * i + k));
        const Eigen::MatrixXd u = gradient * solid.nodes;

        const Eigen::VectorXd force = stiffness_matrix(solid) * u.reshaped();
        const Eigen::MatrixXd stress = (stress_matrix(solid) * u.reshaped()).reshaped(6, n_elements(solid));

        // Round-off: entries of K are about E = 3, displacements up to 2, some 30 products in a row.
        for (Eigen::Index i = 0; i < solid.n_nodes(); ++i) {
          const Eigen::VectorXd x = solid.nodes.col(i);
          if (x.minCoeff() > 1e-9 && x.maxCoeff() < 1.0 - 1e-9)
            CHECK(force.segment(d * i, d).cwiseAbs().maxCoeff() < 1e-13 * 30.0);
        }
        const Eigen::MatrixXd strain = 0.5 * (gradient + gradient.transpose());
        const double shear = 3.0 / 2.6;
        CHECK(stress.cols() == n_elements(solid));
        for (Eigen::Index e = 0; e < stress.cols(); ++e) {
          CHECK(std::abs(stress(3, e) - 2.0 * shear * strain(0, 1)) < 1e-12);   // Hooke
          CHECK((stress.col(e) - stress.col(0)).cwiseAbs().maxCoeff() < 1e-12); // the same everywhere
          if (d == 2 && plane == Plane::stress)
            CHECK(std::abs(stress(0, e) - 3.0 / 0.91 * (strain(0, 0) + 0.3 * strain(1, 1))) < 1e-12);
          if (d == 2) {
            const double zz = plane == Plane::strain ? 0.3 * (stress(0, e) + stress(1, e)) : 0.0;
            CHECK(stress(2, e) == doctest::Approx(zz).epsilon(1e-13));
          }
          if (d == 3) CHECK(std::abs(stress(5, e) - 2.0 * shear * strain(0, 2)) < 1e-12);
        }
      }
}

TEST_CASE("an element resists every motion but the rigid ones")
{
  for (const auto shape : all_shapes)
    for (const auto formulation : formulations) {
      CAPTURE(mesh_files::facts(shape).name);
      const auto x = distorted(shape);
      const int d = static_cast<int>(x.rows()), n_rigid = d == 2 ? 3 : 6;
      REQUIRE(smallest_jacobian(shape, x) > 0.0);

      const auto k = element_stiffness(shape, formulation, x, elasticity({1.0, 0.3, 1.0, Plane::strain}, d));
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(k);

      const auto& values = solver.eigenvalues();
      CHECK(values.head(n_rigid).cwiseAbs().maxCoeff() < 1e-14 * values.tail(1)[0] * 10.0); // round-off
      CHECK(values[n_rigid] > 1e-3 * values.tail(1)[0]);
    }
}

TEST_CASE("an element's mass is density times volume, and consistent mass gives a rigid motion its kinetic energy")
{
  for (const auto shape : all_shapes) {
    CAPTURE(mesh_files::facts(shape).name);
    const auto x = distorted(shape);

    const auto mass = element_mass(shape, x, 2.5);

    CHECK(mass.sum() == doctest::Approx(2.5 * element_volume(shape, x)).epsilon(1e-14));
    CHECK(mass.isApprox(mass.transpose()));
  }
  // A triangle of area 1/2: rho A/12 (1 + delta_ab), from any book; a square of side 2: rho 4/36 (4, 2, 1, 2).
  const auto triangle = element_mass(Shape::triangle3, reference_nodes(Shape::triangle3), 1.0);
  CHECK(triangle(0, 0) == doctest::Approx(1.0 / 12.0));
  CHECK(triangle(0, 1) == doctest::Approx(1.0 / 24.0));
  const auto square = element_mass(Shape::quadrilateral4, reference_nodes(Shape::quadrilateral4), 1.0);
  CHECK(square(0, 0) == doctest::Approx(4.0 / 9.0));
  CHECK(square(0, 1) == doctest::Approx(2.0 / 9.0));
  CHECK(square(0, 2) == doctest::Approx(1.0 / 9.0));
}

TEST_CASE("on parallelograms the enhanced quadrilateral is the hybrid one of Pian and Sumihara")
{
  Eigen::Matrix2d shear;
  shear << 1.5, 0.4, -0.2, 0.7;
  const Eigen::MatrixXd x = shear * reference_nodes(Shape::quadrilateral4);
  for (const auto plane : {Plane::stress, Plane::strain}) {
    const auto c = elasticity({2.0, 0.35, 1.0, plane}, 2);

    const auto enhanced = element_stiffness(Shape::quadrilateral4, Formulation::enhanced, x, c);

    CHECK((enhanced - pian_sumihara(x, c)).cwiseAbs().maxCoeff() < 1e-13 * c.maxCoeff() * 8.0); // round-off
    const auto standard = element_stiffness(Shape::quadrilateral4, Formulation::standard, x, c);
    CHECK((enhanced - standard).cwiseAbs().maxCoeff() > 1e-2); // they do differ
  }
}

TEST_CASE("a single enhanced element bends as a beam does, a standard one is far too stiff")
{
  // Pure bending of a strip of length 10 and height 1 by the couple of a linear stress sigma = y on its ends: the exact
  // solution is u_x = x y / E in plane stress, in 2D and in 3D without lateral contraction.
  for (const auto shape : {Shape::quadrilateral4, Shape::hexahedron8}) {
    Eigen::MatrixXd x = 0.5 * reference_nodes(shape);
    x.row(0) *= 10.0;
    const Eigen::Index d = x.rows();
    const auto c = elasticity({1.0, 0.0, 1.0, Plane::stress}, static_cast<int>(d));
    Eigen::VectorXd u(d * x.cols());
    for (Eigen::Index a = 0; a < x.cols(); ++a) {
      u.segment(d * a, d).setZero();
      u[d * a] = x(0, a) * x(1, a);
    }
    const auto energy = [&](Formulation f) { return 0.5 * u.dot(element_stiffness(shape, f, x, c) * u); };

    const double exact = 0.5 * 10.0 / 12.0; // of sigma = y over length 10, height 1 (and width 1): E/2 int y^2
    CHECK(energy(Formulation::enhanced) == doctest::Approx(exact).epsilon(1e-13));
    // Standard: the shear strain x/2 ... int x^2 dV / 2 * G/... adds G/2 int x^2 = 0.25 * 1000/12.
    CHECK(energy(Formulation::standard) == doctest::Approx(exact + 0.25 * 1000.0 / 12.0).epsilon(1e-13));
  }
}

TEST_CASE("an element that is turned over, flat or has a flat corner has no positive smallest Jacobian")
{
  Eigen::MatrixXd quad = reference_nodes(Shape::quadrilateral4);
  CHECK(smallest_jacobian(Shape::quadrilateral4, quad) == doctest::Approx(1.0));
  CHECK(smallest_jacobian(Shape::quadrilateral4, quad.rowwise().reverse()) < 0.0); // clockwise
  quad.col(2) << 0.0, 0.0; // on the diagonal between its neighbours
  CHECK(std::abs(smallest_jacobian(Shape::quadrilateral4, quad)) < 1e-15);
}
