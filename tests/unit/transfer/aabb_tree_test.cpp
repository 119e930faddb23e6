// The tree against looking at every face, and the closest point of a face in each region around it.
#include "surface/aabb_tree.hpp"

#include "support/surface_pairs.hpp"
#include "surface/shape_functions.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

/// A wavy sheet of n x n quadrilaterals, every other one cut into two triangles.
SurfaceMesh sheet(int n)
{
  SurfaceMesh mesh;
  mesh.nodes.resize(3, (n + 1) * (n + 1));
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
      mesh.nodes.col(j * (n + 1) + i) << x, y, 0.1 * std::sin(5.0 * x) * std::cos(4.0 * y);
    }
  mesh.face_begin = {0};
  const auto add = [&](std::initializer_list<std::int32_t> nodes) {
    mesh.face_nodes.insert(mesh.face_nodes.end(), nodes);
    mesh.face_begin.push_back(static_cast<std::int32_t>(mesh.face_nodes.size()));
  };
  for (std::int32_t j = 0; j < n; ++j)
    for (std::int32_t i = 0; i < n; ++i) {
      const std::int32_t a = j * (n + 1) + i, b = a + 1, c = b + n + 1, d = a + n + 1;
      if ((i + j) % 2 == 0) add({a, b, c, d});
      else add({a, b, c}), add({a, c, d});
    }
  return mesh;
}

Point random_point(std::mt19937_64& engine)
{
  const auto number = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  const double x = 1.4 * number() - 0.2, y = 1.4 * number() - 0.2, z = number() - 0.5;
  return {x, y, z};
}

SurfaceMesh one_triangle()
{
  SurfaceMesh mesh;
  mesh.nodes = Eigen::MatrixXd{{0.0, 4.0, 0.0}, {0.0, 0.0, 4.0}, {0.0, 0.0, 0.0}};
  mesh.face_begin = {0, 3};
  mesh.face_nodes = {0, 1, 2};
  return mesh;
}

} // namespace

TEST_CASE("the closest face is the one that looking at all of them finds")
{
  const auto mesh = sheet(9);
  const FaceTree tree(mesh, 0.01);
  std::mt19937_64 engine{2004};
  for (int i = 0; i < 500; ++i) {
    const Point x = random_point(engine);
    Closest best = closest_on_face(mesh, 0, x);
    for (std::int64_t f = 1; f < mesh.n_faces(); ++f)
      if (const auto next = closest_on_face(mesh, f, x); next.distance < best.distance) best = next;

    const auto found = tree.closest(x);

    CHECK(found.distance == best.distance);
    CHECK(found.face == best.face); // the smallest number among equals
    CHECK((map_to_space(mesh, found.face, found.xi) - x).norm() == found.distance);
  }
}

TEST_CASE("no point of the surface is closer than the closest one")
{
  const auto mesh = sheet(4);
  const FaceTree tree(mesh);
  std::mt19937_64 engine{1974};
  for (int i = 0; i < 100; ++i) {
    const Point x = random_point(engine);
    const double distance = tree.closest(x).distance;
    double sampled = 1e9;
    for (std::int64_t f = 0; f < mesh.n_faces(); ++f)
      for (int a = 0; a <= 20; ++a)
        for (int b = 0; b <= (mesh.face(f).size() == 3 ? 20 - a : 20); ++b) {
          const double xi[2] = {a / 20.0, b / 20.0};
          sampled = std::min(sampled, (map_to_space(mesh, f, xi) - x).norm());
        }

    CHECK(distance <= sampled + 1e-12);
    CHECK(distance > sampled - 0.02); // half the spacing of the samples, 0.25 / 20 * sqrt(2)
  }
}

TEST_CASE("a corner that faces share belongs to the one with the smallest number")
{
  const auto mesh = sheet(9);
  const FaceTree tree(mesh);
  for (std::int32_t node = 0; node < mesh.n_nodes(); ++node) {
    std::int32_t first = -1;
    for (std::int32_t f = 0; f < mesh.n_faces() && first < 0; ++f)
      for (const auto n : mesh.face(f))
        if (n == node) first = f;

    CHECK(tree.closest(node_position(mesh, node)).face == first);
  }
}

TEST_CASE("a query of a box finds every face whose box touches it")
{
  const auto mesh = sheet(9);
  const double inflate = 0.03;
  const FaceTree tree(mesh, inflate);
  std::mt19937_64 engine{42};
  for (int i = 0; i < 100; ++i) {
    const Point a = random_point(engine), b = random_point(engine);
    const Point lo = a.cwiseMin(b), hi = a.cwiseMax(b);
    std::vector<std::int32_t> expected, found;
    for (std::int32_t f = 0; f < mesh.n_faces(); ++f) {
      Point face_lo = node_position(mesh, mesh.face(f)[0]), face_hi = face_lo;
      for (const auto n : mesh.face(f)) {
        face_lo = face_lo.cwiseMin(node_position(mesh, n));
        face_hi = face_hi.cwiseMax(node_position(mesh, n));
      }
      if (((face_lo.array() - inflate) <= hi.array()).all() && ((face_hi.array() + inflate) >= lo.array()).all())
        expected.push_back(f);
    }

    tree.for_each_in_box(lo, hi, [&](std::int32_t f) { found.push_back(f); });

    std::sort(found.begin(), found.end());
    CHECK(found == expected);
  }
}

TEST_CASE("each region around a triangle has its closest point")
{
  const auto mesh = one_triangle();
  const auto check = [&](const Point& x, double xi, double eta, double distance) {
    const auto closest = closest_on_face(mesh, 0, x);
    CHECK(closest.xi[0] == doctest::Approx(xi).epsilon(1e-14));
    CHECK(closest.xi[1] == doctest::Approx(eta).epsilon(1e-14));
    CHECK(closest.distance == doctest::Approx(distance).epsilon(1e-14));
  };
  check({1, 1, 2}, 0.25, 0.25, 2.0);            // above the inside
  check({-1, -1, 0}, 0.0, 0.0, std::sqrt(2.0)); // the three corners
  check({6, -1, 0}, 1.0, 0.0, std::sqrt(5.0));  //
  check({-1, 6, 0}, 0.0, 1.0, std::sqrt(5.0));  //
  check({1, -3, 0}, 0.25, 0.0, 3.0);            // the three edges
  check({-3, 1, 4}, 0.0, 0.25, 5.0);            //
  check({3, 3, 0}, 0.5, 0.5, std::sqrt(2.0));   //
}

TEST_CASE("a polyline's tree leaves out faces without extent")
{
  const auto mesh = polyline({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}});

  const auto closest = FaceTree(mesh).closest({1.0, 3.0, 0.0});

  CHECK(closest.face == 0); // and not 1
  CHECK(closest.xi[0] == 1.0);
  CHECK(closest.distance == 3.0);
}

TEST_CASE("the nearest node is found, the smaller number among equals")
{
  const auto mesh = along(flat, 10);
  const NodeTree tree(mesh);

  CHECK(tree.closest({0.52, 1.0, 0.0}) == 5);
  CHECK(tree.closest({-3.0, 0.0, 0.0}) == 0);
  CHECK(NodeTree(polyline({{0.0, 0.0}, {1.0, 0.0}})).closest({0.5, 7.0, 0.0}) == 0);
}

TEST_CASE("sides whose normals point against each other are recognised")
{
  const auto fluid = along(arc, 12), solid = along(arc, 7);

  CHECK_FALSE(normals_oppose(fluid, solid, FaceTree(solid)));
  CHECK(normals_oppose(reversed(fluid), solid, FaceTree(solid)));
}
