// Surfaces for the tests of the overlay: grids of triangles, quadrilaterals or both over a rectangle of parameters,
// mapped into space, with nodes shifted at random, so that two meshes of one surface have nothing in common.
#pragma once

#include "surface/surface_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace mullion::testing {

using surface::Point;
using surface::SurfaceMesh;

enum class Faces { triangles, quadrilaterals, mixed };

/// From [0, 1]^2 to a surface [m].
using SurfaceMap = std::function<Point(double, double)>;

inline void add_face(SurfaceMesh& mesh, const std::vector<std::int32_t>& nodes)
{
  if (mesh.face_begin.empty()) mesh.face_begin.push_back(0);
  mesh.face_nodes.insert(mesh.face_nodes.end(), nodes.begin(), nodes.end());
  mesh.face_begin.push_back(static_cast<std::int32_t>(mesh.face_nodes.size()));
}

inline SurfaceMesh mesh_of(const std::vector<Point>& nodes, const std::vector<std::vector<std::int32_t>>& faces)
{
  SurfaceMesh mesh;
  mesh.nodes.resize(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) mesh.nodes.col(static_cast<Eigen::Index>(i)) = nodes[i];
  for (const auto& face : faces) add_face(mesh, face);
  return mesh;
}

struct Grid {
  int n_u = 1, n_v = 1;
  Faces faces = Faces::triangles;
  double shift = 0.0; ///< largest random shift of a node, in cells; boundary nodes stay on the boundary
  unsigned seed = 0;
  int refine = 1; ///< every cell is cut evenly into refine x refine, after the shift: the shapes of the faces stay
};

/// Cells of triangles are cut along a random diagonal, mixed cells are cut or not at random, all parts of a refined
/// cell alike.
inline SurfaceMesh grid_on(const SurfaceMap& map, const Grid& grid)
{
  std::mt19937 random(grid.seed);
  const auto uniform = [&] { return 2.0 * (static_cast<double>(random()) / 4294967296.0) - 1.0; };
  std::vector<std::array<double, 2>> base; // parameters of the cells' corners
  for (int j = 0; j <= grid.n_v; ++j)
    for (int i = 0; i <= grid.n_u; ++i) {
      const double du = grid.shift * uniform(), dv = grid.shift * uniform();
      base.push_back(
          {(i + (i > 0 && i < grid.n_u ? du : 0.0)) / grid.n_u, (j + (j > 0 && j < grid.n_v ? dv : 0.0)) / grid.n_v});
    }
  struct Cut {
    bool is_cut, is_other_diagonal;
  };
  std::vector<Cut> cuts;
  for (int cell = 0; cell < grid.n_u * grid.n_v; ++cell) {
    const bool is_cut = grid.faces == Faces::triangles || (grid.faces == Faces::mixed && uniform() > 0.0);
    cuts.push_back({is_cut, uniform() > 0.0});
  }

  const int r = grid.refine, n_u = r * grid.n_u, n_v = r * grid.n_v;
  SurfaceMesh mesh;
  mesh.nodes.resize(3, (n_u + 1) * (n_v + 1));
  for (int j = 0; j <= n_v; ++j)
    for (int i = 0; i <= n_u; ++i) {
      const int cell_i = std::min(i / r, grid.n_u - 1), cell_j = std::min(j / r, grid.n_v - 1);
      const double a = static_cast<double>(i) / r - cell_i, b = static_cast<double>(j) / r - cell_j;
      std::array<double, 2> at = {0.0, 0.0};
      for (std::size_t c = 0; c < 2; ++c) {
        const auto corner = [&](int di, int dj) {
          return base[static_cast<std::size_t>((cell_j + dj) * (grid.n_u + 1) + cell_i + di)][c];
        };
        at[c] = (1.0 - b) * ((1.0 - a) * corner(0, 0) + a * corner(1, 0)) +
                b * ((1.0 - a) * corner(0, 1) + a * corner(1, 1));
      }
      mesh.nodes.col(j * (n_u + 1) + i) = map(at[0], at[1]);
    }
  for (int j = 0; j < n_v; ++j)
    for (int i = 0; i < n_u; ++i) {
      const std::int32_t a = j * (n_u + 1) + i, b = a + 1, c = b + n_u + 1, d = c - 1;
      const Cut& cut = cuts[static_cast<std::size_t>((j / r) * grid.n_u + i / r)];
      if (!cut.is_cut) add_face(mesh, {a, b, c, d});
      else if (!cut.is_other_diagonal) add_face(mesh, {a, b, c}), add_face(mesh, {a, c, d});
      else add_face(mesh, {a, b, d}), add_face(mesh, {b, c, d});
    }
  return mesh;
}

/// The faces run the other way round: normals point to the other side.
inline SurfaceMesh turned_over(const SurfaceMesh& mesh)
{
  SurfaceMesh turned = mesh;
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    const auto begin = static_cast<std::size_t>(mesh.face_begin[static_cast<std::size_t>(f)]);
    const std::size_t n = mesh.face(f).size();
    for (std::size_t k = 0; k < n; ++k) turned.face_nodes[begin + k] = mesh.face(f)[n - 1 - k];
  }
  return turned;
}

inline SurfaceMesh moved(SurfaceMesh mesh, const std::function<Point(const Point&)>& motion)
{
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) mesh.nodes.col(i) = motion(mesh.nodes.col(i));
  return mesh;
}

/// Both meshes in one, the second one's nodes behind the first one's.
inline SurfaceMesh joined(const SurfaceMesh& a, const SurfaceMesh& b)
{
  SurfaceMesh mesh = a;
  mesh.nodes.conservativeResize(3, a.nodes.cols() + b.nodes.cols());
  mesh.nodes.rightCols(b.nodes.cols()) = b.nodes;
  for (std::int64_t f = 0; f < b.n_faces(); ++f) {
    std::vector<std::int32_t> nodes;
    for (const auto node : b.face(f)) nodes.push_back(node + static_cast<std::int32_t>(a.nodes.cols()));
    add_face(mesh, nodes);
  }
  return mesh;
}

/// A parallelogram in a tilted plane, 1 m by about 0.8 m.
inline Point flat(double u, double v)
{
  return Point(0.3, -0.2, 0.5) + u * Point(0.8, 0.36, 0.48) + v * Point(-0.1, 0.7, -0.35);
}

/// The cap of a sphere around the origin over a square: 1.4 m wide at radius 2 m.
inline SurfaceMap cap(double radius)
{
  return [radius](double u, double v) -> Point {
    return radius * Point(0.7 * (u - 0.5), 0.7 * (v - 0.5), 1.0).normalized();
  };
}

/// A swept, tapered and twisted wing, once around from the lower side of the sharp trailing edge to its upper side:
/// NACA 0012 with a closed trailing edge, root chord 1 m, tip chord 0.5 m, span 1.5 m, 30 degrees of sweep, 5 of twist.
inline Point wing(double u, double v)
{
  const double s = 2.0 * u - 1.0, x = s * s, a = std::abs(s); // smooth around the nose: z ~ 0.1781 s
  const double z = 0.6 * (0.2969 * a - 0.1260 * x - 0.3516 * x * x + 0.2843 * x * x * x - 0.1036 * x * x * x * x);
  const double chord = 1.0 - 0.5 * v, twist = -5.0 * std::numbers::pi / 180.0 * v;
  const double along = chord * (x - 0.25), up = chord * (s < 0.0 ? -z : z);
  return {0.25 + 1.5 * v * std::tan(std::numbers::pi / 6.0) + along * std::cos(twist) + up * std::sin(twist), 1.5 * v,
          up * std::cos(twist) - along * std::sin(twist)};
}

} // namespace mullion::testing
