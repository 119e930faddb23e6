// Meshes of solids for tests, as formulas: an arch, Cook's membrane, and patches with random inner nodes.
#pragma once

#include "elastic_solid/solid.hpp"
#include "files/generators.hpp"

#include <cmath>

namespace mullion::testing {

using elastic_solid::Solid;

/// The elements of a generated mesh, material of its own.
inline Solid solid_of(const mesh_files::MeshFile& mesh)
{
  Solid solid;
  solid.nodes = mesh.nodes;
  for (const auto& block : mesh.blocks)
    if (mesh_files::facts(block.shape).dimension == mesh.dimension) solid.blocks.push_back(block);
  return solid;
}

/// A mesh on the unit square or cube, its inner nodes moved at random. Mixed shapes do not occur.
inline Solid patch(mesh_files::Shape shape, int n = 3)
{
  using mesh_files::Shape;
  if (shape == Shape::triangle3 || shape == Shape::quadrilateral4) {
    const auto cells = shape == Shape::triangle3 ? mesh_files::Cells::triangles : mesh_files::Cells::quads;
    return solid_of(mesh_files::box_2d({n, n, cells, {0.24, 7}}, {1.0, 1.0}));
  }
  const auto volumes = shape == Shape::tetrahedron4 ? mesh_files::Volumes::tets : mesh_files::Volumes::hexes;
  return solid_of(mesh_files::box_3d({n, n, n}, volumes, {1.0, 1.0, 1.0}, {0, 0, 0}, {0.16, 7}));
}

/// n x m quadrilaterals, the image of the unit square. Node i + (n + 1) j is the image of (i/n, j/m).
template <class Map> Solid mapped(int n, int m, const Map& map)
{
  auto solid = solid_of(mesh_files::box_2d({n, m, mesh_files::Cells::quads, {}}, {1.0, 1.0}));
  for (auto x : solid.nodes.colwise()) x = map(x[0], x[1]).eval();
  return solid;
}

/// Cook's membrane: 48 long, from 44 to 16 high. Clamped at x = 0.
inline Solid cook_membrane(int n)
{
  return mapped(n, n, [](double s, double t) {
    const double bottom = 44.0 * s, top = 44.0 + 16.0 * s;
    return Eigen::Vector2d(48.0 * s, bottom + t * (top - bottom));
  });
}

/// A circular arch, by the length of its middle surface, its thickness and its angle [rad]; left end to right end, the
/// highest point on the y axis. Row j = 0 is the inner face, j = m the outer.
inline Solid arch(int n, int m, double length, double thickness, double angle)
{
  const double radius = length / angle;
  return mapped(n, m, [=](double s, double t) {
    const double at = angle * (s - 0.5), r = radius + thickness * (t - 0.5);
    return Eigen::Vector2d(r * std::sin(at), r * std::cos(at));
  });
}

/// Degrees of freedom of the nodes for which `is_held` is false.
template <class Test> std::vector<elastic_solid::Index> free_dofs(const Solid& solid, const Test& is_held)
{
  std::vector<elastic_solid::Index> free;
  const Eigen::Index d = solid.dimension();
  for (Eigen::Index i = 0; i < solid.n_nodes(); ++i)
    for (Eigen::Index k = 0; k < d; ++k)
      if (!is_held(i, k)) free.push_back(static_cast<elastic_solid::Index>(i * d + k));
  return free;
}

/// The two rows of nodes at the ends of a mapped() mesh.
inline auto at_ends(int n)
{
  return [n](Eigen::Index node, Eigen::Index) { return node % (n + 1) == 0 || node % (n + 1) == n; };
}

} // namespace mullion::testing
