// Conjugate gradients with a symmetric Gauss-Seidel step against factors, on matrices that are easy and hard.
#include "surface/mass_solver.hpp"

#include "support/overlay_meshes.hpp"
#include "support/surface_pairs.hpp"

#include <Eigen/SparseCholesky>
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

std::vector<bool> none_pinned(const Operator& m)
{
  return std::vector<bool>(static_cast<std::size_t>(m.rows()), false);
}

} // namespace

TEST_CASE("conjugate gradients solve what factors solve, one to three components, also on slivers")
{
  const SurfaceMap stretched = [](double u, double v) { return Point(u, 1e-3 * v, 0.0); };
  for (const auto& mesh : {grid_on(wing, {12, 9, Faces::mixed, 0.24, 1, 1}), along(arc, 50),
                           grid_on(stretched, {12, 9, Faces::triangles, 0.24, 1, 1})})
    for (int n_components = 1; n_components <= 3; ++n_components) {
      const Operator m = native_mass(mesh);
      const Field right = apply(m, Field::Random(n_components, mesh.n_nodes()));
      Field found;

      REQUIRE(conjugate_gradients(scaled_mass(m, none_pinned(m)), right, found));

      const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(m);
      const Eigen::MatrixXd expected = factors.solve(right.transpose().eval());
      CHECK((found - expected.transpose()).cwiseAbs().maxCoeff() < 1e-14); // round-off times a condition of 10 or so
    }
}

TEST_CASE("a component does not change with those beside it")
{
  const auto mesh = along(arc, 50);
  const Operator m = native_mass(mesh);
  const auto scaled = scaled_mass(m, none_pinned(m));
  Field right = Field::Random(3, mesh.n_nodes()), all, alone;
  right.row(1).setZero();

  REQUIRE(conjugate_gradients(scaled, right, all));
  REQUIRE(conjugate_gradients(scaled, right.row(2), alone));

  CHECK(all.row(1).cwiseAbs().maxCoeff() == 0.0);
  CHECK(all.row(2) == alone);
}

TEST_CASE("pinned nodes get zero and do not disturb the others")
{
  const Operator m = assembled(3, 3, std::vector<Entry>{{0, 0, 2.0}, {0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 2.0}});
  Field found;

  REQUIRE(conjugate_gradients(scaled_mass(m, {false, false, true}), Field{{3.0, 3.0, 7.0}}, found));

  CHECK((found - Field{{1.0, 1.0, 0.0}}).cwiseAbs().maxCoeff() < 1e-15);
}

TEST_CASE("what cannot be solved is said and is no number")
{
  const Operator indefinite = assembled(2, 2, std::vector<Entry>{{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 2.0}, {1, 1, 1.0}});
  const Operator sound = assembled(2, 2, std::vector<Entry>{{0, 0, 1.0}, {1, 1, 1.0}});
  Field found;

  CHECK_FALSE(conjugate_gradients(scaled_mass(indefinite, {false, false}), Field{{1.0, -1.0}}, found));
  CHECK(found.array().isNaN().all());
  CHECK_FALSE(conjugate_gradients(scaled_mass(sound, {false, false}), Field{{1.0, std::nan("")}}, found));
  CHECK(found.array().isNaN().all());
}
