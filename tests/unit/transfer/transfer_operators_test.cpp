// The bundle of operators against its parts, for a nodal and a facial source.
#include "surface/transfer_operators.hpp"

#include "support/surface_pairs.hpp"
#include "surface/balance.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

std::vector<TransferOperators> every_kind(const SurfaceMesh& source, const SurfaceMesh& target, Location location)
{
  const FaceTree tree(target);
  std::vector<TransferOperators> all;
  all.push_back(operators_of_projection(source, target, node_projection(source, target, tree), location));
  all.push_back(operators_of_projection(source, target, nearest_nodes(source, target), location));
  all.push_back(operators_of_points(source, target, tree, quadrature_points(source, target, tree, {.n_points = 3}),
                                    location, MassMetric::native));
  all.push_back(operators_of_points(source, target, tree, refined(source, target), location, MassMetric::same));
  return all;
}

} // namespace

TEST_CASE("loads from tractions and from the loads of the same tractions agree in sum")
{
  const auto source = along(arc, 23), target = along(arc, 30);
  const Field nodal = Field::Random(2, source.n_nodes()), facial = Field::Random(2, source.n_faces());
  const Field nodal_loads = apply(native_mass(source), nodal);
  Field facial_loads = facial;
  for (std::int64_t f = 0; f < source.n_faces(); ++f) facial_loads.col(f) *= face_measure(source, f);

  // Sums of some 50 numbers below 0.1: round-off.
  for (const auto& operators : every_kind(source, target, Location::nodes)) {
    const Field from_traction = loads_from_traction(operators, nodal);
    const Field from_loads = loads_from_loads(operators, source, nodal_loads);
    CHECK((from_traction.rowwise().sum() - nodal_loads.rowwise().sum()).cwiseAbs().maxCoeff() < 1e-14);
    CHECK((from_loads - from_traction).cwiseAbs().maxCoeff() < 1e-14); // the loads of t are M t
  }
  for (const auto& operators : every_kind(source, target, Location::faces)) {
    const Field from_traction = loads_from_traction(operators, facial);
    const Field from_loads = loads_from_loads(operators, source, facial_loads);
    CHECK((from_traction.rowwise().sum() - facial_loads.rowwise().sum()).cwiseAbs().maxCoeff() < 1e-14);
    CHECK((from_loads - from_traction).cwiseAbs().maxCoeff() < 1e-14);
  }
}

TEST_CASE("adjoint motion keeps the work, interpolation keeps rigid translations, node projection does both")
{
  const auto source = along(arc, 23), target = along(arc, 30);
  const Field traction = Field::Random(2, source.n_nodes()), velocity = Field::Random(2, target.n_nodes());
  const Field source_loads = apply(native_mass(source), traction);
  const Field rigid = Field::Ones(2, target.n_nodes());
  for (const auto& operators : every_kind(source, target, Location::nodes)) {
    REQUIRE(operators.source_mass.is_solvable);
    const double on_target = work_of(loads_from_traction(operators, traction), velocity);
    const double by_adjoint = work_of(source_loads, motion_of_source(operators, velocity, Motion::adjoint));
    const double by_interpolation = work_of(source_loads, motion_of_source(operators, velocity, Motion::interpolate));

    CHECK(std::abs(on_target - by_adjoint) < 1e-13);
    CHECK((std::abs(on_target - by_interpolation) < 1e-13) == operators.is_projection);
    for (const Motion motion : {Motion::interpolate, Motion::adjoint})
      CHECK((motion_of_source(operators, rigid, motion).array() - 1.0).abs().maxCoeff() < 1e-13);
  }
}

TEST_CASE("with a facial source the adjoint motion of the nodes comes from the nodal operator")
{
  const auto source = along(arc, 23), target = along(arc, 30);
  const Field velocity = Field::Random(2, target.n_nodes());
  const auto nodal = every_kind(source, target, Location::nodes), facial = every_kind(source, target, Location::faces);
  for (std::size_t k = 0; k < nodal.size(); ++k)
    CHECK(motion_of_source(nodal[k], velocity, Motion::adjoint) ==
          motion_of_source(facial[k], velocity, Motion::adjoint));
}
