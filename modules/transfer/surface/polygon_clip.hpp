// Convex polygons in a plane, cut by lines: what the overlay of two surfaces does with each pair of faces. A polygon
// carries numbers on its vertices that vary linearly, so that a cut needs no division by the area of a thin face.
#pragma once

#include <array>

namespace mullion::surface {

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
[[nodiscard]] HalfPlane left_of(double p_x, double p_y, double q_x, double q_y);

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
[[nodiscard]] std::array<double, 2> inverse_bilinear(const std::array<std::array<double, 2>, 4>& corners, double p_x,
                                                     double p_y);

} // namespace mullion::surface
