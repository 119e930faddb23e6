// A face as a polygon in a plane: what is needed to cut it, and the way back to local coordinates. A triangle lies in
// one plane, a quadrilateral in its mean plane or, warped, in the planes of its halves.
#pragma once

#include "polygon_clip.hpp"
#include "surface_mesh.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
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
  [[nodiscard]] Point position(const PlanePoint& p) const { return origin + p[0] * x + p[1] * y; }
};

/// A convex polygon in its plane: a face, or half of it.
struct FacePart {
  Frame frame;
  int n = 0;                         ///< corners
  PlaneCorners corner{};             ///< in the plane, counterclockwise
  PlaneCorners local{};              ///< local coordinates of the corners in the face
  std::array<HalfPlane, 4> inside{}; ///< left of each edge
  double area = 0.0;                 ///< [m^2]
};

/// A face in its plane or planes.
struct PlaneFace {
  int n_parts = 0; ///< 0: the face is degenerate
  std::array<FacePart, 2> parts{};
  bool is_bilinear = false; ///< a convex quadrilateral: local coordinates are found in the mean plane
  Frame mean{};             ///< if so
  PlaneCorners corner{};    ///< in the mean plane, if so
  Point lo, hi;             ///< the face's box [m]
  double length = 0.0;      ///< of the longest edge [m]
};

/// A face of a mesh in its plane. A quadrilateral is cut in two if it is warped by more than 10 degrees (the normals at
/// its corners against that of its mean plane) or has a corner that points inwards. Parts whose area is less than 1e-14
/// of the square of the longest edge are left out.
[[nodiscard]] PlaneFace plane_face(const SurfaceMesh& mesh, std::int32_t f);

/// Local coordinates in the face of a point in the plane of one of its parts: bilinear in a convex quadrilateral, also
/// if it is cut in two; else linear in the part. Never outside the face.
[[nodiscard]] PlanePoint local_coordinates(const PlaneFace& face, const FacePart& part, const PlanePoint& point);

} // namespace mullion::surface
