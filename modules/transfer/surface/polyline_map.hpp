// The one-to-one map between two smooth pieces of polyline that run the same way: which places of the one belong to
// which places of the other. Every node of either side becomes a breakpoint, so that between two breakpoints both lie
// in one face. For the 2D overlay.
#pragma once

#include "polyline_chains.hpp"
#include "surface_mesh.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace mullion::surface {

/// A chain, or a part of it, as it is walked. A place on it is a number: position of the face + share of it.
struct Path {
  std::vector<std::int32_t> faces; ///< of the mesh
  std::vector<std::int32_t> nodes; ///< n_faces + 1, of the mesh
  std::vector<Point> x;            ///< n_faces + 1 [m]
  std::vector<Point> normals; ///< n_faces + 1: means of the unit normals (dy, -dx) of the faces around a node, unit
  std::vector<double> arc;    ///< n_faces + 1: length up to a node [m]
  bool is_reversed = false;   ///< against the faces' own direction

  [[nodiscard]] std::size_t n_faces() const { return faces.size(); }
};

/// Faces first, …, first + n_faces - 1 of the chain, counted as it is walked; a loop may be walked further than once.
[[nodiscard]] Path path_along(const SurfaceMesh& mesh, const Chain& chain, bool is_reversed, std::size_t first,
                              std::size_t n_faces);

/// Point of a path at a place [m].
[[nodiscard]] Point point_at(const Path& path, double place);

/// Local coordinate within its own face of a place that lies in the face at this position.
[[nodiscard]] double local_coordinate(const Path& path, std::size_t position, double place);

/// A pair of places that belong together.
struct Breakpoint {
  double source, target;
};

/// Which ends of the two paths are the same point, a corner say.
struct PathEnds {
  bool start_is_same = false, end_is_same = false;
  double target_start = 0.0, target_end = 0.0; ///< the part of the target that is looked at
};

struct PathMap {
  std::vector<Breakpoint> points;              ///< neither side decreases; the source from 0 to n_faces
  double covered_from = 0.0, covered_to = 0.0; ///< of the source: outside, it is clamped to the target's end
  std::vector<std::size_t> missed_source;      ///< node positions whose place is interpolated or clamped
  std::vector<std::size_t> missed_target;      ///< node positions whose place is interpolated
};

/// The map along the target's interpolated normals n(xi) = (1 - xi) n_1 + xi n_2.
///
///     source node p:  cross(p - a - xi d, n_1 + xi (n_2 - n_1)) = 0, a quadratic, on a target face a, a + d
///     target node q:  cross(a + xi d - q, n_q) = 0 on a source face a, a + d           cf. Jiao & Heath 2004
///
/// Both use the same lines, so the map is one-to-one while |gap| * curvature < 1. Where it is not (thin bodies, gaps
/// that are too wide) the longest sequence of pairs that keeps the order counts, and what it leaves out is
/// interpolated over the lengths. Places closer than 1e-10 of a face to a node are that node: the two breakpoints
/// merge, and no interval is lost.
[[nodiscard]] PathMap map_paths(const Path& source, const Path& target, const PathEnds& ends);

/// Where a source node lands on a path; a negative place: nowhere.
///
/// @param normal  of the source there: hits on a side that faces the other way do not count
[[nodiscard]] double land_on_path(const Path& target, const Point& x, const Point& normal);

} // namespace mullion::surface
