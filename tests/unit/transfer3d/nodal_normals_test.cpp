// One normal per node.
#include "surface/nodal_normals.hpp"

#include "support/overlay_meshes.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::testing;
using mullion::surface::nodal_normals;

TEST_CASE("on a sphere inner nodes have the sphere's normal, whatever the mesh")
{
  for (const Faces faces : {Faces::triangles, Faces::mixed}) {
    const auto mesh = grid_on(cap(2.0), {5, 4, faces, 0.24, 3});

    const auto normals = nodal_normals(mesh);

    for (int j = 1; j < 4; ++j)
      for (int i = 1; i < 5; ++i) {
        const Eigen::Index node = j * 6 + i;
        const Point exact = mesh.nodes.col(node) / 2.0;
        CHECK((normals.col(node) - exact).norm() < 1e-13); // round-off over edges of 0.1
      }
  }
}

TEST_CASE("the normals at the edges of a box do not depend on how its sides are cut")
{
  // Two faces of a box that meet along x = 1; the upper side is cut finer.
  const auto box = mesh_of({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}, {1, 0, 0}, {1, 1, 0}, {0.9, 0.1, 1}},
                           {{0, 1, 6}, {1, 2, 6}, {2, 3, 6}, {3, 0, 6}, {1, 4, 5, 2}});

  const auto normals = nodal_normals(box);

  CHECK((normals.col(1) - Point(1, 0, 1).normalized()).norm() < 1e-15); // round-off
  CHECK((normals.col(2) - Point(1, 0, 1).normalized()).norm() < 1e-15);
  CHECK((normals.col(6) - Point(0, 0, 1)).norm() < 1e-15);
}

TEST_CASE("nodes at the same place have the same normal, unless their faces look opposite ways")
{
  // Two strips that meet in y = 0 with an angle, each with nodes of its own, and a sheet that lies back to back on one.
  const auto strips =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, -1, -0.5}, {1, -1, -0.5}, {1, 0, 0}, {0, 0, 0}},
              {{0, 1, 2, 3}, {4, 5, 6, 7}});
  const auto sheet = mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 1, 0}, {1, 0, 0}}, {{0, 1, 2, 3}});

  const auto normals = nodal_normals(joined(strips, sheet));

  const Point joint = (Point(0, 0, 1) + Point(0, -0.5, 1).normalized()).normalized();
  for (const int node : {0, 1, 6, 7}) CHECK((normals.col(node) - joint).norm() < 1e-15); // round-off
  CHECK((normals.col(2) - Point(0, 0, 1)).norm() < 1e-15);
  for (const int node : {8, 9, 10, 11}) CHECK((normals.col(node) - Point(0, 0, -1)).norm() < 1e-15);
}

TEST_CASE("a node that only faces without area use has no normal")
{
  const auto mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {3, 0, 0}}, {{0, 1, 2}, {1, 3, 4}});

  const auto normals = nodal_normals(mesh);

  CHECK(normals.col(4).norm() == 0.0);
  CHECK((normals.col(1) - Point(0, 0, 1)).norm() == 0.0);
}
