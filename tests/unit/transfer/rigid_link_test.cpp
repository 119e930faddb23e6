// Surfaces that stand off from one another, joined by rigid arms: rigid rotations and moments arrive whole.
#include "surface/rigid_link.hpp"

#include "support/overlay_meshes.hpp"
#include "support/surface_pairs.hpp"
#include "surface/balance.hpp"
#include "surface/overlay_operators.hpp"
#include "surface/surface_overlay.hpp"
#include "surface/transfer_operators.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

/// Nearest neighbour, node projection, quadrature projection and common refinement.
std::vector<TransferOperators> every_kind(const SurfaceMesh& source, const SurfaceMesh& target, Location location,
                                          Offsets offsets)
{
  const FaceTree tree(target);
  std::vector<TransferOperators> all;
  for (const auto& p : {nearest_nodes(source, target), node_projection(source, target, tree)}) {
    all.push_back(operators_of_projection(source, target, p, location));
    if (offsets == Offsets::rigid_link) add_rigid_links(all.back(), source, target, tree);
  }
  OverlayAssembly quadrature(source, target, location, Metric::source, MassMetric::native, SourceMass::factorised,
                             offsets);
  for_each_quadrature_face(source, target, tree, {.n_points = 2},
                           [&](std::int32_t face, auto points) { quadrature.add_points(face, points); });
  all.push_back(quadrature.finish(tree));
  OverlayAssembly refinement(source, target, location, Metric::source, MassMetric::same, SourceMass::factorised,
                             offsets);
  const auto take = [&](const Subelement& piece) { refinement.add(piece); };
  if (source.dimension == 2) (void)overlay_polylines(source, target, {}, take);
  else (void)overlay_surfaces(source, target, {}, take);
  all.push_back(refinement.finish(tree));
  return all;
}

/// A small rotation about an axis that is none of the coordinates', and a translation.
Field rigid_motion(const SurfaceMesh& mesh)
{
  const Point axis = mesh.dimension == 2 ? Point(0.0, 0.0, 0.4) : Point(0.3, -0.5, 0.4);
  Field motion(mesh.dimension, mesh.n_nodes());
  for (Eigen::Index i = 0; i < motion.cols(); ++i)
    motion.col(i) = (Point(0.1, 0.2, 0.3) + axis.cross(node_position(mesh, i))).head(mesh.dimension);
  return motion;
}

struct Pair {
  SurfaceMesh source, target;
};

/// A gap of a twentieth of the radius; in 3D one surface, for rims that coincide are covered in full.
std::vector<Pair> pairs()
{
  const Curve wide = [](double s) { return Eigen::Vector2d(1.05 * arc(s)); };
  const SurfaceMap plane = [](double u, double v) { return Point(u, v, 0.0); };
  const SurfaceMap lifted = [](double u, double v) { return Point(u, v, 0.05); };
  return {{along(wide, 23), reversed(along(arc, 17))},
          {grid_on(lifted, {9, 9, Faces::triangles, 0.24, 1, 1}),
           turned_over(grid_on(plane, {7, 7, Faces::mixed, 0.24, 2, 1}))},
          {grid_on(plane, {6, 6, Faces::triangles, 0.24, 1, 1}),
           grid_on(lifted, {7, 7, Faces::quadrilaterals, 0.24, 2, 1})}};
}

} // namespace

TEST_CASE("with rigid links a rigid motion arrives whole, without them short by the arm")
{
  for (const auto& [source, target] : pairs()) {
    const Field given = rigid_motion(target), expected = rigid_motion(source);
    for (const Motion motion : {Motion::interpolate, Motion::adjoint}) {
      const auto error = [&](const TransferOperators& operators) {
        return (motion_of_source(operators, given, motion) - expected).cwiseAbs().maxCoeff();
      };
      const auto plain = every_kind(source, target, Location::nodes, Offsets::left_out);
      const auto linked = every_kind(source, target, Location::nodes, Offsets::rigid_link);
      for (std::size_t k = 0; k < linked.size(); ++k) {
        CAPTURE(k);
        const bool is_on_one_metric = k != 2 || motion == Motion::interpolate; // quadrature has native masses
        if (is_on_one_metric) CHECK(error(linked[k]) < 1e-12);                 // round-off of a solve
        CHECK(error(plain[k]) > 1e-3);                                         // 0.4 rad times 0.05 m, or a part of it
      }
    }
  }
}

TEST_CASE("with rigid links the moment arrives whole, of nodes and of faces, and the force as before")
{
  for (const auto& [source, target] : pairs())
    for (const auto location : {Location::nodes, Location::faces}) {
      const Field traction =
          Field::Random(source.dimension, location == Location::nodes ? source.n_nodes() : source.n_faces());
      const auto plain = every_kind(source, target, location, Offsets::left_out);
      const auto linked = every_kind(source, target, location, Offsets::rigid_link);
      for (std::size_t k = 0; k < linked.size(); ++k) {
        CAPTURE(k);
        Balance balance;
        balance.source = resultant_of_traction(source, traction, location);
        balance.target = resultant_of_loads(target, loads_from_traction(linked[k], traction));
        CHECK(defects_of(balance).force < 1e-14);
        CHECK(defects_of(balance).moment < 1e-12);
        balance.target = resultant_of_loads(target, loads_from_traction(plain[k], traction));
        CHECK(defects_of(balance).moment > 1e-4); // or the links are worth nothing
      }
    }
}

TEST_CASE("with rigid links adjoint motion keeps the work, and loads become loads with force and moment")
{
  for (const auto& [source, target] : pairs()) {
    const Field traction = Field::Random(source.dimension, source.n_nodes());
    const Field velocity = Field::Random(source.dimension, target.n_nodes());
    for (const auto& operators : every_kind(source, target, Location::nodes, Offsets::rigid_link)) {
      const Field forces = apply(operators.source_mass.matrix, traction); // on the metric of the loads
      const Field loads = loads_from_traction(operators, traction);

      const double on_target = work_of(loads, velocity);
      const double on_source = work_of(forces, motion_of_source(operators, velocity, Motion::adjoint));
      const Field from_loads = loads_from_loads(operators, source, forces);

      CHECK(std::abs(on_target - on_source) < 1e-13 * work_scale_of(loads, velocity));
      CHECK((from_loads - loads).cwiseAbs().maxCoeff() < 1e-13 * loads.cwiseAbs().maxCoeff());
    }
  }
}
