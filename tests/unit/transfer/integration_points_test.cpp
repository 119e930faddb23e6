// Points and weights of pieces and of projected Gauss points.
#include "surface/integration_points.hpp"

#include "support/surface_pairs.hpp"
#include "surface/operators.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

/// A plane quadrilateral that is no parallelogram, as one face, and the same cut along its diagonal.
SurfaceMesh trapezoid(bool is_cut)
{
  SurfaceMesh mesh;
  mesh.nodes = Eigen::MatrixXd{{0.0, 4.0, 3.0, 1.0}, {0.0, 0.0, 2.0, 2.5}, {0.0, 0.0, 0.0, 0.0}};
  mesh.face_begin = is_cut ? std::vector<std::int32_t>{0, 3, 6} : std::vector<std::int32_t>{0, 4};
  mesh.face_nodes = is_cut ? std::vector<std::int32_t>{0, 1, 2, 0, 2, 3} : std::vector<std::int32_t>{0, 1, 2, 3};
  return mesh;
}

Subelement polygon(int source, int target, std::vector<std::array<double, 4>> vertices)
{
  Subelement piece;
  piece.source_face = source;
  piece.target_face = target;
  for (const auto& v : vertices) {
    piece.source_xi[piece.n_vertices][0] = v[0];
    piece.source_xi[piece.n_vertices][1] = v[1];
    piece.target_xi[piece.n_vertices][0] = v[2];
    piece.target_xi[piece.n_vertices][1] = v[3];
    ++piece.n_vertices;
  }
  return piece;
}

/// The pieces of trapezoid(false) over trapezoid(true): its two triangles.
std::vector<Subelement> halves()
{
  return {polygon(0, 0, {{0, 0, 0, 0}, {1, 0, 1, 0}, {1, 1, 0, 1}}),
          polygon(0, 1, {{0, 0, 0, 0}, {1, 1, 1, 0}, {0, 1, 0, 1}})};
}

double sum_of_weights(const PointSet& set)
{
  double sum = 0.0;
  for (const auto& p : set.points) sum += p.weight;
  return sum;
}

} // namespace

TEST_CASE("the weights of a source face sum to its measure, however much its pieces cover")
{
  const auto source = along(flat, 1), target = along(flat, 1);
  Subelement half;
  half.n_vertices = 2;
  half.source_xi[1][0] = half.target_xi[1][0] = 0.5;

  const auto set = points_of_overlay(source, target, std::vector{half}, Metric::source);

  CHECK(set.coverage[0] == doctest::Approx(0.5).epsilon(1e-15));
  CHECK(sum_of_weights(set) == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(sum_of_weights(points_of_overlay(source, target, std::vector{half}, Metric::target)) ==
        doctest::Approx(0.5).epsilon(1e-15)); // the target's metric is not scaled
}

TEST_CASE("the metric decides which side's lengths count")
{
  const auto source = along(flat, 1), target = polyline({{0.0, 0.5}, {3.0, 0.5}});
  Subelement all;
  all.n_vertices = 2;
  all.source_xi[1][0] = all.target_xi[1][0] = 1.0;
  const auto pieces = std::vector{all};

  CHECK(sum_of_weights(points_of_overlay(source, target, pieces, Metric::source)) == doctest::Approx(1.0));
  CHECK(sum_of_weights(points_of_overlay(source, target, pieces, Metric::target)) == doctest::Approx(3.0));
  CHECK(sum_of_weights(points_of_overlay(source, target, pieces, Metric::average)) == doctest::Approx(2.0));
}

TEST_CASE("a source face without pieces gets closest points")
{
  const auto source = along(flat, 2), target = along(flat, 1);
  const FaceTree tree(target);
  Subelement first;
  first.n_vertices = 2;
  first.source_xi[1][0] = 1.0;
  first.target_xi[1][0] = 0.5;
  auto set = points_of_overlay(source, target, std::vector{first}, Metric::source);
  REQUIRE(set.coverage == std::vector<double>{1.0, 0.0});

  REQUIRE(add_closest_points(source, tree, 1, 3, set.points));

  CHECK(set.points.size() == 2 + 3);
  CHECK(sum_of_weights(set) == doctest::Approx(1.0).epsilon(1e-15));
  for (const auto& p : set.points) // both sides at the same place
    CHECK(0.5 * (p.source_face + p.source_xi[0]) == doctest::Approx(p.target_xi[0]).epsilon(1e-15));
}

TEST_CASE("pieces of quadrilaterals pair the same places of both sides, so that linear fields are exact")
{
  for (const bool quadrilateral_is_source : {true, false}) {
    const auto source = trapezoid(!quadrilateral_is_source), target = trapezoid(quadrilateral_is_source);
    auto pieces = halves();
    if (!quadrilateral_is_source)
      for (auto& p : pieces) {
        std::swap(p.source_face, p.target_face);
        std::swap(p.source_xi, p.target_xi);
      }
    const auto linear = [](const Point& x) { return 2.0 - 3.0 * x.x() + 0.5 * x.y(); };

    const auto set = points_of_overlay(source, target, pieces, Metric::source);

    const Field loads = apply(load_operator(source, target, set.points, Location::nodes), nodal_field(source, linear));
    const Field exact = apply(target_mass(target, set.points), nodal_field(target, linear));
    CHECK((loads - exact).cwiseAbs().maxCoeff() < 1e-13); // a few sums of numbers of order ten
    CHECK(sum_of_weights(set) == doctest::Approx(face_measure(trapezoid(false), 0)).epsilon(1e-14));
  }
}

TEST_CASE("polygons of any number of corners have the area of their triangles")
{
  SurfaceMesh square;
  square.nodes = Eigen::MatrixXd{{0.0, 2.0, 2.0, 0.0}, {0.0, 0.0, 2.0, 2.0}, {0.0, 0.0, 0.0, 0.0}};
  square.face_begin = {0, 4};
  square.face_nodes = {0, 1, 2, 3};
  const double c = 0.25; // corners cut off: an octagon
  std::vector<std::array<double, 4>> corners;
  for (const auto& [x, y] : std::vector<std::pair<double, double>>{
           {c, 0}, {1 - c, 0}, {1, c}, {1, 1 - c}, {1 - c, 1}, {c, 1}, {0, 1 - c}, {0, c}})
    corners.push_back({x, y, x, y});

  const auto set = points_of_overlay(square, square, std::vector{polygon(0, 0, corners)}, Metric::target);

  CHECK(sum_of_weights(set) == doctest::Approx(4.0 * (1.0 - 2.0 * c * c)).epsilon(1e-14));
  CHECK(set.coverage[0] == doctest::Approx(1.0 - 2.0 * c * c).epsilon(1e-14));
}

TEST_CASE("adaptive quadrature gives every target face a point and touches only the source faces beside")
{
  // One long source face over ten target faces, and nine short ones over one each.
  std::vector<Eigen::Vector2d> x = {{0.0, 0.0}};
  for (int i = 0; i < 10; ++i) x.emplace_back(1.0 + 0.1 * i, 0.0);
  const auto source = polyline(x), target = along([](double s) { return flat(1.9 * s); }, 19);
  const FaceTree tree(target);
  const auto fixed = quadrature_points(source, target, tree, {.n_points = 2});

  const auto adaptive = quadrature_points(source, target, tree, {.n_points = 2, .is_adaptive = true});

  CHECK(fixed.target_empty.size() == 8); // two points for ten faces
  CHECK(adaptive.target_empty.empty());
  const auto n_on = [&](std::int32_t face) {
    return std::count_if(adaptive.points.begin(), adaptive.points.end(),
                         [&](const auto& p) { return p.source_face == face; });
  };
  CHECK(n_on(0) == 16); // 8 Gauss points leave some of ten equal parts empty
  for (std::int32_t f = 1; f < source.n_faces(); ++f) CHECK(n_on(f) == 2);
}

TEST_CASE("target faces beyond the source stay empty and do not hang the adaption")
{
  const auto source = along(flat, 4), target = along([](double s) { return flat(2.0 * s); }, 8);

  const auto set = quadrature_points(source, target, FaceTree(target), {.n_points = 2, .is_adaptive = true});

  CHECK(set.target_empty == std::vector<std::int32_t>{4, 5, 6, 7});
}

TEST_CASE("the adaptive order is doubled until the load settles")
{
  const auto source = along(flat, 8), target = along(flat, 7);
  const FaceTree tree(target);
  const auto n_points = [&](double tolerance) {
    return quadrature_points(source, target, tree, {.n_points = 2, .is_adaptive = true, .tolerance = tolerance})
        .points.size();
  };

  CHECK(n_points(0.0) == 16);
  CHECK(n_points(0.5) == 32);      // one doubling, which changes little
  CHECK(n_points(1e-9) == 8 * 64); // never reached: the largest order
  CHECK(n_points(1e-3) > n_points(0.5));
  CHECK(n_points(1e-3) < n_points(1e-9));
}
