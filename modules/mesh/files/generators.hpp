// Meshes from formulas, for cases and tests: curves, surfaces and boxes. The same arguments give the same mesh, to the
// bit, on every machine with the same mathematics library; those that only add and multiply on every one.
#pragma once

#include "mesh_file.hpp"

#include <cstdint>
#include <functional>
#include <vector>

namespace mullion::mesh_files {

/// Of a surface or a domain in the plane.
enum class Cells {
  quads,
  triangles,   ///< two a quadrilateral, all cut along the same diagonal
  alternating, ///< cut along one diagonal and the other in turn, as a chessboard has its colours
  delaunay     ///< cut along the diagonal that makes the two angles across it the smaller ones: with perturbed
               ///< nodes a mesh without a pattern
};
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

/// How a box in the plane is divided.
struct Division {
  /// The size of the last cell by that of the first, along each axis; sizes grow by the same factor from cell to cell.
  Eigen::Vector2d ratio = {1.0, 1.0};
  /// A smooth distortion [m]: nodes move by skew sin(2 pi s) sin(2 pi t) along both axes, s and t from 0 to 1 over the
  /// box. Sides stay where they are.
  double skew = 0.0;
};

/// A rectangle in the plane: n x m cells.
MeshFile box_2d(const Grid& grid, const Eigen::Vector2d& size, const Eigen::Vector2d& origin = {0, 0},
                const Division& division = {});

/// n hexahedra, or six tetrahedra for each.
MeshFile box_3d(const Eigen::Vector3i& n, Volumes volumes, const Eigen::Vector3d& size,
                const Eigen::Vector3d& origin = {0, 0, 0}, const Perturbation& perturb = {},
                const Eigen::Vector3d& ratio = {1, 1, 1});

// ---- domains in the plane, each with the group "volume" and its sides, whose normals point outward; every face of the
// boundary is in one group. Perturbed nodes are inner ones only.
// ----------------

/// A clamped circular arch over the x axis, symmetric about x = 0, as solid and as what lies in the fluid's floor: its
/// outer face, of the radius R + thickness/2 with R = length/angle, ends on y = 0.
struct Arch {
  double length = 0.34795;           ///< of the arc halfway through the thickness [m]
  double thickness = 0.006;          ///< [m]
  double angle = 0.2617993877991494; ///< over which the arc goes [rad]; 15 degrees
};

/// The solid: n x m cells along the arc, from x < 0 on, and through the thickness. Groups "wet" (the outer face),
/// "inner", "start" (x < 0), "end".
MeshFile solid_arch(const Grid& grid, const Arch& arch);

/// What surrounds the arch: its outer face as grid.n faces of equal angle, flat floors beside it, grid.m rows of cells
/// whose heights grow by the same factor from row to row, starting with the mean width of the faces where the floor is
/// flat.
struct ArchSurroundings {
  double height = 1.25;            ///< where the roof lies [m]
  double growth = 1.04;            ///< from cell to cell along the floors, away from the arch
  double largest = 0.045;          ///< cells grow up to this width [m]
  double left = -2.2, right = 2.5; ///< the last cell on either side is the first one to reach that far [m]
};

/// A duct over the arch. Groups "shell" (the outer face), "floor", "roof", "inlet" (x < 0), "outlet".
MeshFile duct_over_arch(const Grid& grid, const Arch& arch, const ArchSurroundings& around);

/// A closed box over the arch, with one cell of floor on either side. Groups "shell", "floor", "roof", "left", "right".
MeshFile box_over_arch(const Grid& grid, const Arch& arch, double height, double growth);

/// Ni's channel, 3 m x 1 m, with a circular arc of this height on its floor from x = 1 m to 2 m; nodes are uniform in
/// x, and in y between floor and roof. Groups "bump", "floor", "roof", "inlet", "outlet".
MeshFile channel_with_bump(const Grid& grid, double height);

/// Cook's membrane, a tapered panel with the corners (0, 0), (48, 44), (48, 60), (0, 44). Groups "left", "right",
/// "bottom", "top".
MeshFile cooks_membrane(const Grid& grid);

} // namespace mullion::mesh_files
