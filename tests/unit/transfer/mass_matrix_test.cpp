// Recovery of tractions, adjoint motion, and tractions from forces.
#include "surface/mass_matrix.hpp"

#include "support/surface_pairs.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::surface;
using namespace mullion::testing;

TEST_CASE("solving undoes the matrix for each component")
{
  const auto mesh = along(arc, 20);
  const Field t = Field::Random(2, mesh.n_nodes());
  const MassMatrix mass = mass_matrix(native_mass(mesh));

  REQUIRE(mass.is_solvable);
  CHECK((solve(mass, apply(mass.matrix, t)) - t).cwiseAbs().maxCoeff() < 1e-14); // condition number 3 to 6
  CHECK(mass.row_sums.sum() == doctest::Approx(total_measure(mesh)).epsilon(1e-14));
}

TEST_CASE("nodes without mass are pinned to zero and do not disturb the others")
{
  const Operator m = assembled(3, 3, std::vector<Entry>{{0, 0, 2.0}, {0, 1, 1.0}, {1, 0, 1.0}, {1, 1, 2.0}});
  const MassMatrix mass = mass_matrix(m);

  REQUIRE(mass.is_solvable);
  CHECK(mass.pinned == std::vector<std::int32_t>{2});
  CHECK((recover(mass, Field{{3.0, 3.0, 7.0}}, Recovery::consistent) - Field{{1.0, 1.0, 0.0}}).cwiseAbs().maxCoeff() <
        1e-15);
  CHECK(recover(mass, Field{{3.0, 6.0, 7.0}}, Recovery::lumped) == Field{{1.0, 2.0, 0.0}});
}

TEST_CASE("a matrix that is not positive is refused, not solved")
{
  const Operator m = assembled(2, 2, std::vector<Entry>{{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 2.0}, {1, 1, 1.0}});

  CHECK_FALSE(mass_matrix(m).is_solvable);
}

TEST_CASE("lumped recovery is exact for a constant and positive for a jump, consistent recovery overshoots")
{
  const auto source = along(flat, 40), target = along(flat, 33);
  const auto set = refined(source, target);
  const Operator b = load_operator(source, target, set.points, Location::nodes);
  const MassMatrix mass = mass_matrix(target_mass(target, set.points));
  const Field jump = nodal_field(source, [](const Point& x) { return x.x() < 0.5 ? 0.0 : 1.0; });

  const Field constant = recover(mass, apply(b, Field::Ones(1, 41)), Recovery::lumped);
  const Field lumped = recover(mass, apply(b, jump), Recovery::lumped);
  const Field consistent = recover(mass, apply(b, jump), Recovery::consistent);

  CHECK((constant.array() - 1.0).abs().maxCoeff() < 1e-14);
  CHECK(lumped.minCoeff() >= 0.0);
  CHECK(lumped.maxCoeff() <= 1.0 + 1e-14);
  CHECK(consistent.minCoeff() < -0.01);
}

TEST_CASE("the force of a face becomes its traction, a face without length has none")
{
  const auto mesh = polyline({{0.0, 0.0}, {2.0, 0.0}, {2.0, 0.0}});

  CHECK(traction_of_face_forces(mesh, Field{{3.0, 1.0}, {4.0, 1.0}}) == Field{{1.5, 0.0}, {2.0, 0.0}});
}

TEST_CASE("the adjoint motion is the one that keeps the work of every load")
{
  const auto source = along(arc, 23), target = along(arc, 30);
  const auto set = refined(source, target);
  const Operator b = load_operator(source, target, set.points, Location::nodes);
  const MassMatrix mass = mass_matrix(native_mass(source));
  const Field traction = Field::Random(2, source.n_nodes()), velocity = Field::Random(2, target.n_nodes());

  const Field motion = adjoint_motion(b, mass, velocity);

  const double on_target = apply(b, traction).cwiseProduct(velocity).sum();
  const double on_source = apply(mass.matrix, traction).cwiseProduct(motion).sum();
  CHECK(std::abs(on_target - on_source) < 1e-14); // sums of some 50 numbers below 0.05
}

TEST_CASE("a mass matrix that is too large to be factorised is solved to round-off all the same")
{
  const auto mesh = along(arc, static_cast<int>(largest_factorised) + 100);
  const auto mass = mass_matrix(native_mass(mesh));
  REQUIRE(mass.is_solvable);
  REQUIRE(mass.factors == nullptr);
  const Field traction = Field::Random(2, mesh.n_nodes());

  const Field found = recover(mass, apply(mass.matrix, traction), Recovery::consistent);

  // Residual at round-off, times the condition of a line's mass matrix, 3, and its lumped form's.
  CHECK((found - traction).cwiseAbs().maxCoeff() < 1e-13);
}
