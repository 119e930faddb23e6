// Measures of faces by hand, and what is wrong with a mesh in words.
#include "surface/surface_mesh.hpp"

#include "support/surface_pairs.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

/// A unit square in the plane z = 0 and a right triangle beside it.
SurfaceMesh square_and_triangle()
{
  SurfaceMesh mesh;
  mesh.nodes.resize(3, 5);
  mesh.nodes << 0, 1, 1, 0, 3, //
      0, 0, 1, 1, 0,           //
      0, 0, 0, 0, 0;
  mesh.face_begin = {0, 4, 7};
  mesh.face_nodes = {0, 1, 2, 3, 1, 4, 2};
  return mesh;
}

} // namespace

TEST_CASE("measures, normals and centres of faces are those by hand")
{
  const auto mesh = square_and_triangle();

  CHECK(complaint_about(mesh) == "");
  CHECK(face_measure(mesh, 0) == doctest::Approx(1.0).epsilon(1e-15));
  CHECK(face_measure(mesh, 1) == doctest::Approx(1.0).epsilon(1e-15)); // 2 * 1 / 2
  CHECK(total_measure(mesh) == doctest::Approx(2.0).epsilon(1e-15));
  CHECK(face_normal(mesh, 0) == Point(0, 0, 1));
  CHECK(face_normal(mesh, 1) == Point(0, 0, 1));
  CHECK(face_centre(mesh, 0) == Point(0.5, 0.5, 0.0));
  CHECK(face_size(mesh, 1) == doctest::Approx(1.0).epsilon(1e-15));
}

TEST_CASE("a line's normal is to the right of its direction")
{
  const auto mesh = polyline({{0.0, 0.0}, {2.0, 0.0}, {2.0, 3.0}});

  CHECK(face_normal(mesh, 0) == Point(0, -1, 0));
  CHECK(face_normal(mesh, 1) == Point(1, 0, 0));
  CHECK(face_measure(mesh, 1) == 3.0);
  CHECK(mean_face_size(mesh) == 2.5);
}

TEST_CASE("the area of a plane trapezoid is exact")
{
  SurfaceMesh mesh;
  mesh.nodes.resize(3, 4);
  mesh.nodes << 0, 4, 3, 1, //
      0, 0, 2, 2,           //
      1, 1, 1, 1;
  mesh.face_begin = {0, 4};
  mesh.face_nodes = {0, 1, 2, 3};

  CHECK(face_measure(mesh, 0) == doctest::Approx(6.0).epsilon(1e-15)); // (4 + 2) / 2 * 2
}

TEST_CASE("faces without extent are found and no others")
{
  const auto mesh = polyline({{0.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0 + 1e-6, 0.0}, {2.0, 0.0}});

  CHECK(degenerate_faces(mesh) == std::vector<std::int32_t>{1});
  CHECK(complaint_about(mesh) == "");
}

TEST_CASE("complaints name the place and what would be right")
{
  const auto complains = [](const SurfaceMesh& mesh, const char* words) {
    const auto complaint = complaint_about(mesh);
    CHECK_MESSAGE(complaint.find(words) != std::string::npos, complaint);
  };
  auto mesh = square_and_triangle();
  mesh.face_nodes[4] = 9;
  complains(mesh, "face 1 names node 9; the nodes are 0 to 4");

  mesh = square_and_triangle();
  mesh.face_nodes[5] = 1;
  complains(mesh, "face 1 names node 1 twice");

  mesh = square_and_triangle();
  mesh.nodes(1, 2) = std::nan("");
  complains(mesh, "the coordinates of node 2");

  mesh = square_and_triangle();
  mesh.face_begin = {0, 5, 7};
  complains(mesh, "face 0 has 5 nodes; in 3D it must have 3 or 4");

  mesh = square_and_triangle();
  mesh.face_begin.back() = 6;
  complains(mesh, "face_begin must rise from 0 to 7");

  mesh = square_and_triangle();
  mesh.dimension = 2;
  complains(mesh, "nodes have 3 coordinates in 2 dimensions");

  mesh = square_and_triangle();
  mesh.nodes.setZero();
  complains(mesh, "no face has an area");

  complains(SurfaceMesh{}, "no faces");

  mesh = polyline({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}});
  std::swap(mesh.face_nodes[2], mesh.face_nodes[3]);
  complains(mesh, "two faces meet against each other in node 1 at (1, 0) m");
}

TEST_CASE("a node that three lines share is a branch and no mistake")
{
  auto mesh = polyline({{0.0, 0.0}, {1.0, 0.0}, {2.0, 0.0}, {1.0, 1.0}});
  mesh.face_nodes = {0, 1, 1, 2, 1, 3};

  CHECK(complaint_about(mesh) == "");
}
