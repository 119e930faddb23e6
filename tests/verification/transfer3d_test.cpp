// Order of convergence of the transfer between two meshes of one surface in 3D by common refinement: least squares in
// the metric of the overlay, from nodal and from facial values. The meshes are shifted at random, independently of each
// other, and refined evenly, so that the shapes of the faces stay and the order shows. And fields that go to and fro
// between two meshes many times.
#include "support/overlay_assembly.hpp"
#include "support/overlay_meshes.hpp"
#include "support/worst.hpp"
#include "surface/overlay_operators.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

double field(const Point& x)
{
  return std::sin(2.0 * x.x() + 0.5) * std::cos(x.y() + 1.0) + 0.5 * std::sin(2.0 * x.z());
}

struct Errors {
  double nodal_l2, nodal_max, facial_l2;
};

/// Errors of the recovered nodal values against the field. Facial values are means of the nodal ones.
Errors errors(const SurfaceMap& surface, Faces faces, int refine)
{
  const auto source = grid_on(surface, {5, 5, faces, 0.24, 1, refine});
  const auto target = turned_over(grid_on(surface, {4, 4, faces, 0.24, 2, refine}));
  Eigen::VectorXd at_source(source.n_nodes()), at_target(target.n_nodes()), at_faces(source.n_faces());
  for (Eigen::Index i = 0; i < source.n_nodes(); ++i) at_source[i] = field(source.nodes.col(i));
  for (Eigen::Index i = 0; i < target.n_nodes(); ++i) at_target[i] = field(target.nodes.col(i));
  for (std::int64_t f = 0; f < source.n_faces(); ++f) {
    at_faces[f] = 0.0;
    for (const auto node : source.face(f)) at_faces[f] += at_source[node] / static_cast<double>(source.face(f).size());
  }

  const auto m = assemble(source, target);

  const Eigen::SimplicialLDLT<Sparse> mass(m.target_mass);
  const Eigen::VectorXd nodal = mass.solve(m.nodal * at_source) - at_target;
  const Eigen::VectorXd facial = mass.solve(m.facial * at_faces) - at_target;
  return {std::sqrt(nodal.dot(m.target_mass * nodal)), nodal.lpNorm<Eigen::Infinity>(),
          std::sqrt(facial.dot(m.target_mass * facial))};
}

struct Case {
  std::string name;
  SurfaceMap surface;
};
const std::vector<Case> surfaces = {{"flat", flat}, {"cap", cap(2.0)}, {"wing", wing}};

/// Orders between the coarsest and the finest, refined `levels` times by two.
///
/// The largest error belongs to the one place where the two meshes meet least well, another on each level: its order
/// scatters by a tenth, in a plane too, where the overlay is exact.
void check_orders(Faces faces, int coarsest, int levels, double least_order_of_max)
{
  for (const auto& [name, surface] : surfaces) {
    const auto coarse = errors(surface, faces, coarsest), fine = errors(surface, faces, coarsest << levels);
    const auto order = [&](double Errors::*e) { return std::log2(coarse.*e / fine.*e) / levels; };

    CAPTURE(name);
    CAPTURE(order(&Errors::nodal_l2));
    CAPTURE(order(&Errors::nodal_max));
    CAPTURE(order(&Errors::facial_l2));
    CHECK(order(&Errors::nodal_l2) >= 1.9);
    CHECK(order(&Errors::nodal_max) >= least_order_of_max);
    CHECK(order(&Errors::facial_l2) >= 1.1); // 1 for shapes that vary at random from face to face, 3/2 for even ones
    CHECK(fine.nodal_l2 < 4e-3 * 16.0 / ((coarsest << levels) * (coarsest << levels))); // a bound, with the order
  }
}

/// Transfers a field of the fluid to the structure and back, both as least squares on one metric.
void check_round_trips(const SurfaceMap& surface, Faces faces, Metric metric, int n, double most_lost)
{
  const auto fluid = grid_on(surface, {32, 32, faces, 0.24, 1, 1});
  const auto solid = turned_over(grid_on(surface, {27, 27, faces, 0.24, 2, 1}));
  OverlayAssembly assembly(fluid, solid, Location::nodes, metric, MassMetric::same);
  (void)overlay_surfaces(fluid, solid, {}, [&](const Subelement& piece) { assembly.add(piece); });
  const auto operators = assembly.finish(FaceTree(solid));
  Field start(1, fluid.n_nodes());
  for (Eigen::Index i = 0; i < fluid.n_nodes(); ++i) start(0, i) = field(fluid.nodes.col(i));
  const auto norm = [&](const Field& f) {
    return std::sqrt(f.cwiseProduct(apply(operators.source_mass.matrix, f)).sum());
  };

  double largest_ratio = 0.0; // of the norms before and after a trip
  Field values = start;
  for (int i = 0; i < n; ++i) {
    const double before = norm(values);
    const Field there = recover(operators.target_mass, loads_from_traction(operators, values), Recovery::consistent);
    values = motion_of_source(operators, there, Motion::adjoint);
    largest_ratio = worst(largest_ratio, norm(values) / before);
  }

  CAPTURE(norm(values - start) / norm(start));
  CHECK(largest_ratio < 1.0 + 1e-10); // projections on one metric do not raise the norm; round-off of two solves
  CHECK(norm(values - start) < most_lost * norm(start)); // they lose, trip by trip, what the other mesh can't hold
}

} // namespace

TEST_CASE("a field that goes to and fro between surfaces a hundred times neither grows nor is lost")
{
  for (const Faces faces : {Faces::triangles, Faces::quadrilaterals, Faces::mixed}) {
    check_round_trips(flat, faces, Metric::source, 100, 2e-2);
    check_round_trips(cap(2.0), faces, Metric::average, 100, 2e-2);
    check_round_trips(wing, faces, Metric::average, 100, 2e-2);
  }
}

TEST_CASE("transfer between surface meshes in 3D is of second order in the mean and in the largest error")
{
  check_orders(Faces::triangles, 4, 2, 1.9);
  check_orders(Faces::quadrilaterals, 4, 2, 1.9);
}

TEST_SUITE("full")
{
  TEST_CASE("a field that goes to and fro between surfaces a thousand times does not grow")
  {
    for (const Faces faces : {Faces::triangles, Faces::quadrilaterals, Faces::mixed}) {
      check_round_trips(flat, faces, Metric::source, 1000, 0.1);
      check_round_trips(cap(2.0), faces, Metric::average, 1000, 0.1);
      check_round_trips(wing, faces, Metric::average, 1000, 0.1);
    }
  }

  TEST_CASE("transfer between finer surface meshes in 3D is of second order, with all kinds of faces")
  {
    check_orders(Faces::triangles, 4, 3, 1.9);
    check_orders(Faces::quadrilaterals, 4, 3, 1.9);
    check_orders(Faces::mixed, 4, 3, 1.85); // of the steps 4 to 32; they rise
    check_orders(Faces::mixed, 32, 1, 1.9);
  }
}
