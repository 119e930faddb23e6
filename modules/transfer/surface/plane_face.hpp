// A face as a polygon in a plane: what is needed to cut it, and the way back to local coordinates. A triangle lies in
// one plane, a quadrilateral in its mean plane or, warped, in the planes of its halves.
#pragma once

#include "polygon_clip.hpp"
#include "surface_mesh.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <cstdint>

namespace mullion::surface {

/// node_position() where the mesh is known to be three-dimensional.
[[nodiscard]] inline Point node_place(const SurfaceMesh& mesh, std::int32_t node)
{
  return Point::Map(mesh.nodes.data() + 3 * std::int64_t{node});
}

/// Local coordinates of the corners of a triangle or a quadrilateral.
[[nodiscard]] const PlaneCorners& local_corners(std::size_t n_nodes);

/// Twice a face's area times its normal; of a quadrilateral in its mean plane (the cross product of its diagonals).
[[nodiscard]] Point twice_area_vector(const SurfaceMesh& mesh, std::int32_t f);

/// A plane with coordinates in it [m].
struct Frame {
  Point origin, x, y, normal;

  [[nodiscard]] PlanePoint coordinates(const Point& p) const { return {(p - origin).dot(x), (p - origin).dot(y)}; }
};

/// Where the line through a node along its normal meets a plane.
struct NodeImage {
  PlanePoint place; ///< [m]
  double gap;       ///< distance from the node, along the normal [m]
};

/// A nodal normal that leaves the plane at less than 30 degrees, at a trailing edge say, is replaced by the plane's
/// own: a gap would move the image by more than its double.
[[nodiscard]] inline NodeImage image_of_node(const Frame& plane, const Point& x, const Point& nodal_normal)
{
  constexpr double least_slope = 0.5;
  const double slope = plane.normal.dot(nodal_normal), height = plane.normal.dot(plane.origin - x);
  if (std::abs(slope) < least_slope) return {plane.coordinates(x), height};
  const double gap = height / slope;
  return {plane.coordinates(x + gap * nodal_normal), gap};
}

/// A convex polygon in its plane: a face, or half of it.
struct FacePart {
  Frame frame;
  int n = 0;                         ///< corners
  PlaneCorners corner{};             ///< in the plane, counterclockwise
  PlaneCorners local{};              ///< local coordinates of the corners in the face
  std::array<HalfPlane, 4> inside{}; ///< left of each edge
  double area = 0.0;                 ///< [m^2]
  bool is_bilinear = false; ///< of a quadrilateral whose image is convex: local coordinates are those of the image
  PlaneCorners image{};     ///< if so: of the whole quadrilateral
};

/// A face in its plane or planes.
struct PlaneFace {
  int n_parts = 0; ///< 0: the face is degenerate
  std::array<FacePart, 2> parts{};
  Point lo, hi;        ///< the face's box [m]
  double length = 0.0; ///< of the longest edge [m]
};

/// A face of a mesh in its plane. A quadrilateral is taken in its mean plane, its corners projected along the nodal
/// normals (as those of the other side's faces are: identical faces have identical images). It is cut in two if it is
/// warped by more than 10 degrees (the normals at its corners against that of its mean plane) or has a corner that
/// points inwards. Parts whose area is less than 1e-14 of the square of the longest edge are left out.
///
/// @param normals  nodal_normals() of the mesh; not looked at for a triangle
[[nodiscard]] PlaneFace plane_face(const SurfaceMesh& mesh, std::int32_t f, const Eigen::Matrix3Xd& normals);

/// Local coordinates in the face of a point in the plane of one of its parts: bilinear in a convex quadrilateral, also
/// if it is cut in two; else linear in the part. Never outside the face.
[[nodiscard]] PlanePoint local_coordinates(const FacePart& part, const PlanePoint& point);

} // namespace mullion::surface
