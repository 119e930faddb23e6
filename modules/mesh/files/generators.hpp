// Meshes from formulas, for cases and tests: curves, surfaces and boxes. The same arguments give the same mesh, to the
// bit, on every machine with the same mathematics library; those that only add and multiply on every one.
#pragma once

#include "mesh_file.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace mullion::mesh_files {

enum class Cells { quads, triangles }; ///< of a surface
enum class Volumes { hexes, tets };

/// How far the inner nodes are moved from their places: at random, in each direction up to this part of the distance
/// to the next node. Nodes on an edge or a face of the domain stay on it.
struct Perturbation {
  double part = 0.0;      ///< below 0.25 for surfaces and below 1/6 for volumes, so that no element turns over
  std::uint64_t seed = 1; ///< the same seed gives the same mesh
};

// ---- curves: n lines, from the first node to the last
// ----------------------------------------------------------------

MeshFile line(int n, const Eigen::VectorXd& from, const Eigen::VectorXd& to);

/// Nodes at s = 0, 1/n, …, 1 of the function.
MeshFile polyline(int n, const std::function<Eigen::VectorXd(double s)>& function);

/// In the plane, counterclockwise for a positive angle. @param from, angle [rad]
MeshFile arc(int n, double radius, double from, double angle, const Eigen::Vector2d& centre = {0.0, 0.0});

// ---- surfaces in space: normals, by the right-hand rule, towards +z where they are flat
// -------------------------------

struct Grid {
  int n = 1, m = 1; ///< cells along the two directions
  Cells cells = Cells::quads;
  Perturbation perturb;
};

/// The image of the grid on the unit square, (s, t) in [0, 1]².
MeshFile surface(const Grid& grid, const std::function<Eigen::Vector3d(double s, double t)>& function);

MeshFile rectangle(const Grid& grid, double length_x, double length_y, const Eigen::Vector3d& origin = {0, 0, 0});

/// The part of a sphere about the origin within an angle of the +z axis; normals point outward. n rings of m cells
/// each; the cells at the pole are triangles.
/// @param angle [rad], in (0, pi)
MeshFile spherical_cap(int n, int m, Cells cells, double radius, double angle);

/// A wing as one sheet. The root's chord lies on the x axis from 0 to `root`; the span goes along y.
struct Wing {
  double span = 1.0, root = 1.0, tip = 1.0; ///< span and chords [m]
  double sweep = 0.0;                       ///< of the leading edge [rad], backward positive
  double twist = 0.0;                       ///< of the tip about the quarter chord [rad], nose up positive
  double camber = 0.0;                      ///< of the parabolic mean line, part of the chord
};
/// n cells along the chord, m along the span.
MeshFile wing_panel(const Grid& grid, const Wing& wing);

// ---- boxes, with the groups "volume" and "x_min", "x_max", … of the sides, whose normals point outward
// ----------------

/// A rectangle in the plane: n x m cells.
MeshFile box_2d(const Grid& grid, const Eigen::Vector2d& size, const Eigen::Vector2d& origin = {0, 0});

/// n hexahedra, or six tetrahedra for each.
MeshFile box_3d(const Eigen::Vector3i& n, Volumes volumes, const Eigen::Vector3d& size,
                const Eigen::Vector3d& origin = {0, 0, 0}, const Perturbation& perturb = {});

} // namespace mullion::mesh_files
