// Faces in their planes.
#include "surface/plane_face.hpp"

#include "support/overlay_meshes.hpp"
#include "surface/nodal_normals.hpp"
#include "surface/shape_functions.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

/// A square whose last corner is lifted.
SurfaceMesh warped(double lift) { return mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, lift}}, {{0, 1, 2, 3}}); }

PlaneFace in_plane(const SurfaceMesh& mesh, std::int32_t f) { return plane_face(mesh, f, nodal_normals(mesh)); }

} // namespace

TEST_CASE("a triangle is one part with its own area and local coordinates")
{
  const auto mesh = mesh_of({{1, 1, 1}, {3, 1, 2}, {1, 4, 0}}, {{0, 1, 2}});

  const auto face = in_plane(mesh, 0);

  REQUIRE(face.n_parts == 1);
  CHECK(face.parts[0].area == doctest::Approx(0.5 * Point(2, 0, 1).cross(Point(0, 3, -1)).norm()).epsilon(1e-15));
  const double xi[2] = {0.25, 0.5};
  const auto place = face.parts[0].frame.coordinates(map_to_space(mesh, 0, xi));
  const auto found = local_coordinates(face.parts[0], place);
  CHECK(found[0] == doctest::Approx(0.25).epsilon(1e-14)); // round-off
  CHECK(found[1] == doctest::Approx(0.5).epsilon(1e-14));
}

TEST_CASE("a quadrilateral is cut in two if it is warped by more than ten degrees")
{
  // The normals at the corners beside the lifted one lean by atan(lift) or so against each other, half of it against
  // the mean plane's.
  CHECK(in_plane(warped(0.0), 0).n_parts == 1);
  CHECK(in_plane(warped(0.1), 0).n_parts == 1);
  CHECK(in_plane(warped(0.5), 0).n_parts == 2);
}

TEST_CASE("local coordinates in the halves of a warped quadrilateral are those of its image in their planes")
{
  const auto mesh = warped(0.5);
  const auto normals = nodal_normals(mesh);
  const auto face = plane_face(mesh, 0, normals);

  for (int half = 0; half < 2; ++half) {
    const auto& part = face.parts[static_cast<std::size_t>(half)];
    const PlanePoint middle = {(part.corner[0][0] + part.corner[1][0] + part.corner[2][0]) / 3.0,
                               (part.corner[0][1] + part.corner[1][1] + part.corner[2][1]) / 3.0};
    const auto found = local_coordinates(part, middle);

    const auto n = shape_values(4, found.data());
    PlanePoint place = {0.0, 0.0};
    for (std::size_t k = 0; k < 4; ++k) {
      const auto image = image_of_node(part.frame, mesh.nodes.col(static_cast<Eigen::Index>(k)),
                                       normals.col(static_cast<Eigen::Index>(k)));
      for (std::size_t c = 0; c < 2; ++c) place[c] += n[k] * image.place[c];
    }
    CHECK(std::abs(place[0] - middle[0]) < 1e-15); // round-off
    CHECK(std::abs(place[1] - middle[1]) < 1e-15);
  }
}

TEST_CASE("a node is projected along its normal, or the plane's if that is too flat")
{
  const Frame plane{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

  const auto along = image_of_node(plane, {2, 3, 0}, Point(0.6, 0.0, 0.8));
  const auto turned = image_of_node(plane, {2, 3, 0}, Point(-0.6, 0.0, -0.8));
  const auto flat_normal = image_of_node(plane, {2, 3, 0}, Point(0.96, 0.0, 0.28));

  CHECK(along.gap == doctest::Approx(1.25).epsilon(1e-15));
  CHECK(along.place[0] == doctest::Approx(2.75).epsilon(1e-15));
  CHECK(along.place[1] == 3.0);
  CHECK(turned.place[0] == along.place[0]);
  CHECK(turned.gap == -along.gap);
  CHECK(flat_normal.place[0] == 2.0);
  CHECK(flat_normal.gap == 1.0);
}

TEST_CASE("a quadrilateral with a corner that points inwards is cut there and keeps its area")
{
  // A triangle with a dent in its long side; once for each position of the dent in the order of the nodes.
  for (std::int32_t turned = 0; turned < 4; ++turned) {
    std::vector<std::int32_t> nodes;
    for (std::int32_t k = 0; k < 4; ++k) nodes.push_back((k + turned) % 4);
    const auto mesh = mesh_of({{0, 0, 0}, {0.3, 0.4, 0}, {1, 1, 0}, {0, 1, 0}}, {nodes});

    const auto face = in_plane(mesh, 0);

    REQUIRE(face.n_parts == 2);
    CHECK_FALSE(face.parts[0].is_bilinear);
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

  CHECK(in_plane(mesh, 0).n_parts == 0);
  CHECK(in_plane(mesh, 1).n_parts == 0);
  CHECK(in_plane(mesh, 2).n_parts == 1);
}
