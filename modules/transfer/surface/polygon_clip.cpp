#include "polygon_clip.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::surface {

namespace {

double corner_area(const ClipVertex& a, const ClipVertex& b, const ClipVertex& c)
{
  return std::abs((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

ClipVertex between(const ClipVertex& inner, const ClipVertex& outer, double t)
{
  const auto mix = [t](double from, double to) { return from + t * (to - from); };
  return {mix(inner.x, outer.x), mix(inner.y, outer.y), mix(inner.xi, outer.xi), mix(inner.eta, outer.eta),
          mix(inner.gap, outer.gap)};
}

void erase(ClipPolygon& polygon, int k)
{
  std::copy(polygon.vertices.begin() + k + 1, polygon.vertices.begin() + polygon.n, polygon.vertices.begin() + k);
  --polygon.n;
}

} // namespace

bool is_convex(const PlaneCorners& c)
{
  return turn(c[3], c[0], c[1]) >= 0.0 && turn(c[0], c[1], c[2]) >= 0.0 && turn(c[1], c[2], c[3]) >= 0.0 &&
         turn(c[2], c[3], c[0]) >= 0.0;
}

bool is_cut_from_1_to_3(const PlaneCorners& c) { return turn(c[0], c[1], c[2]) < 0.0 || turn(c[2], c[3], c[0]) < 0.0; }

HalfPlane left_of(const PlanePoint& p, const PlanePoint& q)
{
  const double length = std::hypot(q[0] - p[0], q[1] - p[1]);
  const double a = (p[1] - q[1]) / length, b = (q[0] - p[0]) / length;
  return {a, b, -(a * p[0] + b * p[1])};
}

void clip(ClipPolygon& polygon, const HalfPlane& side)
{
  const int n = polygon.n;
  std::array<double, ClipPolygon::capacity> distance;
  int n_inside = 0;
  for (int i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    distance[at] = side(polygon.vertices[at].x, polygon.vertices[at].y);
    n_inside += distance[at] >= 0.0 ? 1 : 0;
  }
  if (n_inside == n) return;
  if (n_inside == 0) {
    polygon.n = 0;
    return;
  }

  ClipPolygon kept;
  kept.n = 0;
  const auto keep = [&](const ClipVertex& vertex) {
    if (kept.n < ClipPolygon::capacity) kept.vertices[static_cast<std::size_t>(kept.n++)] = vertex;
  };
  for (int i = 0; i < n; ++i) {
    const auto from = static_cast<std::size_t>(i), to = static_cast<std::size_t>(i + 1 < n ? i + 1 : 0);
    const bool is_inside = distance[from] >= 0.0;
    if (is_inside) keep(polygon.vertices[from]);
    if (is_inside == (distance[to] >= 0.0)) continue;
    const auto inner = is_inside ? from : to, outer = is_inside ? to : from;
    const double t = distance[inner] / (distance[inner] - distance[outer]); // >= 0 less < 0: the quotient exists
    keep(between(polygon.vertices[inner], polygon.vertices[outer], t));
  }
  polygon.n = kept.n;
  std::copy_n(kept.vertices.begin(), kept.n, polygon.vertices.begin());
}

double signed_area(const ClipPolygon& polygon)
{
  if (polygon.n < 3) return 0.0;
  const ClipVertex& origin = polygon.vertices[0];
  double twice = 0.0;
  for (int i = 1; i + 1 < polygon.n; ++i) {
    const ClipVertex &p = polygon.vertices[static_cast<std::size_t>(i)],
                     &q = polygon.vertices[static_cast<std::size_t>(i + 1)];
    twice += (p.x - origin.x) * (q.y - origin.y) - (p.y - origin.y) * (q.x - origin.x);
  }
  return 0.5 * twice;
}

void simplify(ClipPolygon& polygon, double tolerance, int max_vertices)
{
  const auto at = [&](int k) -> const ClipVertex& {
    return polygon.vertices[static_cast<std::size_t>((k + polygon.n) % polygon.n)];
  };
  for (int k = 0; k < polygon.n && polygon.n > 1;) {
    const bool is_double = std::abs(at(k).x - at(k + 1).x) <= tolerance && std::abs(at(k).y - at(k + 1).y) <= tolerance;
    if (is_double) erase(polygon, k);
    else ++k;
  }
  while (polygon.n > max_vertices) {
    int least = 0;
    for (int k = 1; k < polygon.n; ++k)
      if (corner_area(at(k - 1), at(k), at(k + 1)) < corner_area(at(least - 1), at(least), at(least + 1))) least = k;
    erase(polygon, least);
  }
}

PlanePoint inverse_bilinear(const PlaneCorners& corners, const PlanePoint& point)
{
  struct Vector {
    double x, y;
  };
  const auto cross = [](Vector a, Vector b) { return a.x * b.y - a.y * b.x; };
  const auto& [c0, c1, c2, c3] = corners;
  const Vector e{c1[0] - c0[0], c1[1] - c0[1]}, f{c3[0] - c0[0], c3[1] - c0[1]};
  const Vector g{c2[0] - c1[0] - f.x, c2[1] - c1[1] - f.y}, p{point[0] - c0[0], point[1] - c0[1]};

  const double k2 = cross(g, f), k1 = cross(e, f) + cross(p, g), k0 = cross(p, e);
  const double root = std::sqrt(std::max(0.0, k1 * k1 - 4.0 * k0 * k2));
  // (root - k1) / (2 k2) without cancellation. Both forms have a zero denominator at a degenerate corner only: 0 then.
  const double denominator = k1 >= 0.0 ? k1 + root : 2.0 * k2;
  const double numerator = k1 >= 0.0 ? -2.0 * k0 : root - k1;
  const double eta = denominator != 0.0 ? std::clamp(numerator / denominator, 0.0, 1.0) : 0.0;

  const Vector along{e.x + eta * g.x, e.y + eta * g.y}, rest{p.x - eta * f.x, p.y - eta * f.y};
  const double square = along.x * along.x + along.y * along.y; // 0 where two corners coincide: any xi is the point
  const double xi = square > 0.0 ? std::clamp((rest.x * along.x + rest.y * along.y) / square, 0.0, 1.0) : 0.0;
  return {xi, eta};
}

} // namespace mullion::surface
