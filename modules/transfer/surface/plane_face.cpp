#include "plane_face.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace mullion::surface {

namespace {

constexpr double cosine_of_largest_warp = 0.984807753012208; // 10 degrees
constexpr double least_area_share = 1e-14;                   // of the longest edge squared: round-off

constexpr PlaneCorners corners_of_triangle = {{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}, {0.0, 0.0}}};
constexpr PlaneCorners corners_of_quadrilateral = {{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}};

Frame frame_of(const Point& origin, const Point& towards, const Point& normal)
{
  const Point in_plane = (towards - origin) - (towards - origin).dot(normal) * normal;
  const Point x = in_plane.normalized();
  return {origin, x, normal.cross(x), normal};
}

FacePart part_of(const Frame& frame, std::span<const PlanePoint> corners, std::span<const PlanePoint> local)
{
  FacePart part;
  part.frame = frame;
  part.n = static_cast<int>(corners.size());
  std::copy(corners.begin(), corners.end(), part.corner.begin());
  std::copy(local.begin(), local.end(), part.local.begin());
  for (std::size_t k = 0; k < corners.size(); ++k)
    part.inside[k] = left_of(part.corner[k], part.corner[(k + 1) % corners.size()]);
  part.area = 0.5 * turn(part.corner[0], part.corner[1], part.corner[2]);
  if (part.n == 4) part.area += 0.5 * turn(part.corner[0], part.corner[2], part.corner[3]);
  return part;
}

/// Cosine of the largest angle between the normal at a corner and that of the mean plane. Corners of 0 or 180 degrees
/// have no normal and do not count.
double cosine_of_warp(const std::array<Point, 4>& x, const Point& normal, double length)
{
  double cosine = 1.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const Point at_corner = (x[(k + 1) % 4] - x[k]).cross(x[(k + 3) % 4] - x[k]);
    const double size = at_corner.norm();
    if (size > 1e-12 * length * length) cosine = std::min(cosine, at_corner.dot(normal) / size);
  }
  return cosine;
}

} // namespace

const PlaneCorners& local_corners(std::size_t n_nodes)
{
  return n_nodes == 3 ? corners_of_triangle : corners_of_quadrilateral;
}

Point twice_area_vector(const SurfaceMesh& mesh, std::int32_t f)
{
  const auto nodes = mesh.face(f);
  const auto x = [&](std::size_t k) { return node_place(mesh, nodes[k]); };
  return nodes.size() == 3 ? (x(1) - x(0)).cross(x(2) - x(0)) : (x(2) - x(0)).cross(x(3) - x(1));
}

PlaneFace plane_face(const SurfaceMesh& mesh, std::int32_t f, const Eigen::Matrix3Xd& normals)
{
  PlaneFace face;
  const auto nodes = mesh.face(f);
  const std::size_t n = nodes.size();
  std::array<Point, 4> x;
  x.fill(Point::Zero());
  for (std::size_t k = 0; k < n; ++k) x[k] = node_place(mesh, nodes[k]);
  face.lo = face.hi = x[0];
  for (std::size_t k = 0; k < n; ++k) {
    face.lo = face.lo.cwiseMin(x[k]);
    face.hi = face.hi.cwiseMax(x[k]);
    face.length = std::max(face.length, (x[(k + 1) % n] - x[k]).norm());
  }

  const auto& local = local_corners(n);
  const double least_area = least_area_share * face.length * face.length;
  const auto image_in = [&](const Frame& plane) {
    PlaneCorners image;
    for (std::size_t k = 0; k < 4; ++k) image[k] = image_of_node(plane, x[k], normals.col(nodes[k])).place;
    return image;
  };
  const auto add_triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    const Point normal = (x[b] - x[a]).cross(x[c] - x[a]);
    if (!(normal.norm() > 2.0 * least_area)) return;
    const Frame frame = frame_of(x[a], x[b], normal.normalized());
    const std::array corners = {frame.coordinates(x[a]), frame.coordinates(x[b]), frame.coordinates(x[c])};
    const std::array at = {local[a], local[b], local[c]};
    FacePart& part = face.parts[static_cast<std::size_t>(face.n_parts++)] = part_of(frame, corners, at);
    if (n == 4) part.image = image_in(frame), part.is_bilinear = is_convex(part.image);
  };
  if (n == 3) {
    add_triangle(0, 1, 2);
    return face;
  }

  const Point of_diagonals = (x[2] - x[0]).cross(x[3] - x[1]);
  if (!(of_diagonals.norm() > 2.0 * least_area)) return face;
  const Frame mean = frame_of(0.25 * (x[0] + x[1] + x[2] + x[3]), x[2], of_diagonals.normalized());
  const auto image = image_in(mean);
  if (is_convex(image) && cosine_of_warp(x, mean.normal, face.length) >= cosine_of_largest_warp) {
    face.n_parts = 1;
    face.parts[0] = part_of(mean, image, local);
    face.parts[0].image = image;
    face.parts[0].is_bilinear = true;
  } else if (is_cut_from_1_to_3(image)) {
    add_triangle(1, 2, 3);
    add_triangle(1, 3, 0);
  } else {
    add_triangle(0, 1, 2);
    add_triangle(0, 2, 3);
  }
  return face;
}

PlanePoint local_coordinates(const FacePart& part, const PlanePoint& point)
{
  if (part.is_bilinear) return inverse_bilinear(part.image, point);
  std::array<double, 3> share; // barycentric coordinates: distances from the opposite edges over the heights
  double sum = 0.0;
  for (std::size_t k = 0; k < 3; ++k) {
    const HalfPlane& opposite_edge = part.inside[(k + 1) % 3];
    share[k] = std::max(0.0, opposite_edge(point[0], point[1]) / opposite_edge(part.corner[k][0], part.corner[k][1]));
    sum += share[k];
  }
  PlanePoint local = {0.0, 0.0};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 2; ++c) local[c] += share[k] / sum * part.local[k][c];
  return local;
}

} // namespace mullion::surface
