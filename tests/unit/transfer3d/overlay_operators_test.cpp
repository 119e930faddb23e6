// The operators that are summed up while the overlay is cut, against those from all of its integration points.
#include "surface/overlay_operators.hpp"

#include "support/overlay_meshes.hpp"
#include "support/surface_pairs.hpp"
#include "surface/surface_overlay.hpp"

#include <doctest/doctest.h>

#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

double largest_difference(const Operator& a, const Operator& b)
{
  REQUIRE(a.rows() == b.rows());
  REQUIRE(a.cols() == b.cols());
  const Operator difference = a - b;
  double largest = 0.0;
  for (int k = 0; k < difference.nonZeros(); ++k) largest = std::max(largest, std::abs(difference.valuePtr()[k]));
  return largest;
}

void check_same(const SurfaceMesh& source, const SurfaceMesh& target)
{
  const auto overlay = [&](const SubelementSink& sink) {
    if (source.dimension == 2) (void)overlay_polylines(source, target, {}, sink);
    else (void)overlay_surfaces(source, target, {}, sink);
  };
  const FaceTree tree(target);
  for (const auto location : {Location::nodes, Location::faces})
    for (const auto metric : {Metric::source, Metric::average})
      for (const auto mass : {MassMetric::same, MassMetric::native}) {
        std::vector<Subelement> pieces;
        OverlayAssembly assembly(source, target, location, metric, mass);
        overlay([&](const Subelement& piece) {
          pieces.push_back(piece);
          assembly.add(piece);
        });
        const auto set = points_of_overlay(source, target, pieces, metric);

        const auto streamed = assembly.finish(tree);
        const auto expected = operators_of_points(source, target, tree, set, location, mass);

        // Sums of a few tens of products below the area of a face, 0.01, in another order.
        CHECK(largest_difference(streamed.load, expected.load) < 1e-16);
        CHECK(largest_difference(streamed.nodal_load, expected.nodal_load) < 1e-16);
        CHECK(largest_difference(streamed.source_mass.matrix, expected.source_mass.matrix) < 1e-16);
        CHECK(largest_difference(streamed.target_mass.matrix, expected.target_mass.matrix) < 1e-16);
        CHECK(largest_difference(streamed.projection, expected.projection) == 0.0);
      }
}

} // namespace

TEST_CASE("operators summed up piece by piece are those of all integration points")
{
  check_same(along(arc, 170), reversed(along(arc, 130)));
  const SurfaceMap plane = [](double u, double v) { return Point(u, v, 0.0); };
  check_same(grid_on(plane, {12, 12, Faces::triangles, 0.24, 1, 1}),
             turned_over(grid_on(plane, {10, 10, Faces::quadrilaterals, 0.24, 2, 1})));
}

TEST_CASE("any nodal traction keeps its force, also where rims do not coincide")
{
  for (const auto faces : {Faces::triangles, Faces::mixed}) {
    const auto source = grid_on(wing, {9, 9, faces, 0.24, 1, 1});
    const auto target = turned_over(grid_on(wing, {7, 7, Faces::quadrilaterals, 0.24, 2, 1}));
    for (const auto location : {Location::nodes, Location::faces}) {
      OverlayAssembly assembly(source, target, location, Metric::source, MassMetric::same);
      const auto report = overlay_surfaces(source, target, {}, [&](const Subelement& piece) { assembly.add(piece); });
      const auto operators = assembly.finish(FaceTree(target));
      const Field traction = Field::Random(3, location == Location::nodes ? source.n_nodes() : source.n_faces());

      const Field loads = loads_from_traction(operators, traction);

      CHECK(report.min_coverage < 1.0 - 1e-6); // or this tests nothing
      const Field expected =
          location == Location::nodes ? apply(native_mass(source), traction) : apply(face_split(source), traction);
      CHECK((loads.rowwise().sum() - expected.rowwise().sum()).cwiseAbs().maxCoeff() < 1e-14); // of an area of about 1
    }
  }
}

TEST_CASE("a source that reaches beyond the target keeps its force: uncovered faces go to the closest points")
{
  const SurfaceMap wide = [](double u, double v) { return Point(2.0 * u, v, 0.0); };
  const SurfaceMap narrow = [](double u, double v) { return Point(u, v, 0.0); };
  const auto source = grid_on(wide, {20, 10, Faces::triangles, 0.2, 1, 1});
  const auto target = turned_over(grid_on(narrow, {7, 7, Faces::triangles, 0.2, 2, 1}));
  OverlayAssembly assembly(source, target, Location::nodes, Metric::source, MassMetric::same);

  const auto report = overlay_surfaces(source, target, {}, [&](const Subelement& piece) { assembly.add(piece); });
  const auto operators = assembly.finish(FaceTree(target));

  CHECK(report.uncovered_faces.count > 100); // about half of 400
  const Field loads = loads_from_traction(operators, Field::Ones(3, source.n_nodes()));
  for (int c = 0; c < 3; ++c) CHECK(loads.row(c).sum() == doctest::Approx(2.0).epsilon(1e-13)); // the whole area
}
