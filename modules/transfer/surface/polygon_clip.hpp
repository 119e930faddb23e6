// Convex polygons in a plane, cut by lines: what the overlay of two surfaces does with each pair of faces. A polygon
// carries numbers on its vertices that vary linearly, so that a cut needs no division by the area of a thin face.
#pragma once

#include <array>

namespace mullion::surface {

/// A place in a plane.
using PlanePoint = std::array<double, 2>;

/// Corners of a triangle (the fourth one is not used) or a quadrilateral in a plane.
using PlaneCorners = std::array<PlanePoint, 4>;

/// Twice the area of the triangle a b c: positive if it runs counterclockwise.
[[nodiscard]] inline double turn(const PlanePoint& a, const PlanePoint& b, const PlanePoint& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Whether a quadrilateral runs counterclockwise and none of its corners points inwards.
[[nodiscard]] bool is_convex(const PlaneCorners& corners);

/// Whether a quadrilateral that is not convex lies on both sides of the diagonal from corner 1 to 3, so that it has to
/// be cut there; else it is cut from 0 to 2.
[[nodiscard]] bool is_cut_from_1_to_3(const PlaneCorners& corners);

/// A vertex of a polygon: its place in the plane, and what is carried along linearly.
struct ClipVertex {
  double x, y;    ///< place in the plane
  double xi, eta; ///< local coordinates in the face that the polygon is a part of
  double gap;     ///< distance from that face to the plane [m]
};

/// A convex polygon, counterclockwise. A quadrilateral cut by four lines has eight vertices; there is room for more,
/// because round-off may add some on an edge that a line runs along.
struct ClipPolygon {
  static constexpr int capacity = 16;
  int n; ///< vertices; 0: nothing is left
  std::array<ClipVertex, capacity> vertices;
};

/// One side of a line: the points with a x + b y + c >= 0.
struct HalfPlane {
  double a, b, c;

  [[nodiscard]] double operator()(double x, double y) const { return a * x + b * y + c; }
};

/// The points left of the line from p to q; its value is then a distance. @pre p and q differ
[[nodiscard]] HalfPlane left_of(const PlanePoint& p, const PlanePoint& q);

/// Cut off what lies outside (Sutherland & Hodgman 1974). Vertices on the line stay.
///
/// A new vertex is computed from its edge's inner end towards the outer one, so that two polygons that share the edge
/// get the same bits for it, and polygons that tile the plane tile the half-plane.
void clip(ClipPolygon& polygon, const HalfPlane& side);

/// Area, negative for a clockwise polygon.
[[nodiscard]] double signed_area(const ClipPolygon& polygon);

/// Merge neighbouring vertices closer than `tolerance`, and bring the number of vertices down to `max_vertices` by
/// leaving out those whose corners have the least area (round-off, see ClipPolygon).
void simplify(ClipPolygon& polygon, double tolerance, int max_vertices);

/// Local coordinates of a point in a quadrilateral in the plane, (0, 0), (1, 0), (1, 1), (0, 1) at its corners.
///
///     p = corner_0 + xi e + eta f + xi eta g:   (p - corner_0 - eta f) x (e + eta g) = 0, quadratic in eta
///
/// In closed form: the root at which the Jacobian is positive.
/// @pre  the corners are convex and counterclockwise, p lies inside or, by round-off, just outside
[[nodiscard]] PlanePoint inverse_bilinear(const PlaneCorners& corners, const PlanePoint& p);

} // namespace mullion::surface
