// Faces in their planes.
#include "surface/plane_face.hpp"

#include "support/overlay_meshes.hpp"
#include "surface/shape_functions.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

/// A square whose last corner is lifted.
SurfaceMesh warped(double lift) { return mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, lift}}, {{0, 1, 2, 3}}); }

} // namespace

TEST_CASE("a triangle is one part with its own area and local coordinates")
{
  const auto mesh = mesh_of({{1, 1, 1}, {3, 1, 2}, {1, 4, 0}}, {{0, 1, 2}});

  const auto face = plane_face(mesh, 0);

  REQUIRE(face.n_parts == 1);
  CHECK(face.parts[0].area == doctest::Approx(0.5 * Point(2, 0, 1).cross(Point(0, 3, -1)).norm()).epsilon(1e-15));
  const double xi[2] = {0.25, 0.5};
  const auto place = face.parts[0].frame.coordinates(map_to_space(mesh, 0, xi));
  const auto found = local_coordinates(face, face.parts[0], place);
  CHECK(found[0] == doctest::Approx(0.25).epsilon(1e-14)); // round-off
  CHECK(found[1] == doctest::Approx(0.5).epsilon(1e-14));
}

TEST_CASE("a quadrilateral is cut in two if it is warped by more than ten degrees")
{
  // The normals at the corners beside the lifted one lean by atan(lift) or so against each other, half of it against
  // the mean plane's.
  CHECK(plane_face(warped(0.0), 0).n_parts == 1);
  CHECK(plane_face(warped(0.1), 0).n_parts == 1);
  CHECK(plane_face(warped(0.5), 0).n_parts == 2);
}

TEST_CASE("local coordinates in the halves of a warped quadrilateral are bilinear in its mean plane")
{
  const auto mesh = warped(0.5);
  const auto face = plane_face(mesh, 0);

  for (int half = 0; half < 2; ++half) {
    const auto& part = face.parts[static_cast<std::size_t>(half)];
    const PlanePoint middle = {(part.corner[0][0] + part.corner[1][0] + part.corner[2][0]) / 3.0,
                               (part.corner[0][1] + part.corner[1][1] + part.corner[2][1]) / 3.0};
    const auto found = local_coordinates(face, part, middle);

    const auto on_surface = face.mean.coordinates(map_to_space(mesh, 0, found.data()));
    const auto on_part = face.mean.coordinates(part.frame.position(middle));
    CHECK(std::abs(on_surface[0] - on_part[0]) < 1e-15); // round-off
    CHECK(std::abs(on_surface[1] - on_part[1]) < 1e-15);
  }
}

TEST_CASE("a quadrilateral with a corner that points inwards is cut there and keeps its area")
{
  // A triangle with a dent in its long side; once for each position of the dent in the order of the nodes.
  for (std::int32_t turned = 0; turned < 4; ++turned) {
    std::vector<std::int32_t> nodes;
    for (std::int32_t k = 0; k < 4; ++k) nodes.push_back((k + turned) % 4);
    const auto mesh = mesh_of({{0, 0, 0}, {0.3, 0.4, 0}, {1, 1, 0}, {0, 1, 0}}, {nodes});

    const auto face = plane_face(mesh, 0);

    REQUIRE(face.n_parts == 2);
    CHECK_FALSE(face.is_bilinear);
    const double shoelace = 0.5 * (0.3 * 1 - 1 * 0.4 + 1 * 1 - 0 * 1);
    CHECK(face.parts[0].area > 0.0);
    CHECK(face.parts[1].area > 0.0);
    CHECK(face.parts[0].area + face.parts[1].area == doctest::Approx(shoelace).epsilon(1e-15));
  }
}

TEST_CASE("faces without area have no parts")
{
  const std::vector<Point> nodes = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1, 1, 1}};
  const auto mesh = mesh_of(nodes, {{0, 1, 2}, {0, 1, 2, 3}, {0, 1, 4}});

  CHECK(plane_face(mesh, 0).n_parts == 0);
  CHECK(plane_face(mesh, 1).n_parts == 0);
  CHECK(plane_face(mesh, 2).n_parts == 1);
}
