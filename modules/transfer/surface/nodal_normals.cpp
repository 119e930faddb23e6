#include "nodal_normals.hpp"

#include "plane_face.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace mullion::surface {

namespace {

constexpr double smooth_cosine = 0.9; // below: an edge between faces, not curvature
constexpr double same_side_cosine = 0.5;

/// The two edges that leave a corner of a face: to the next node, to the previous one.
struct CornerEdges {
  Point next, previous;
};

CornerEdges edges_at(const SurfaceMesh& mesh, std::span<const std::int32_t> face, std::size_t k)
{
  const std::size_t n = face.size();
  const Point x = node_place(mesh, face[k]);
  return {node_place(mesh, face[(k + 1) % n]) - x, node_place(mesh, face[(k + n - 1) % n]) - x};
}

Point unit_or_zero(const Point& v)
{
  const double length = v.norm();
  return length > 0.0 ? Point(v / length) : Point::Zero();
}

/// Give nodes at the same place the mean of their normals, those that point the same way.
void join_seams(const SurfaceMesh& mesh, Eigen::Matrix3Xd& normals)
{
  const std::int64_t n = mesh.n_nodes();
  const Point lo = mesh.nodes.rowwise().minCoeff(), hi = mesh.nodes.rowwise().maxCoeff();
  const double extent = (hi - lo).maxCoeff();
  if (!(extent > 0.0)) return;

  // Buckets of 1e-8 of the extent, off the round places where nodes tend to be: few nodes that belong together are
  // in different ones, and few others share one.
  std::vector<std::pair<std::uint64_t, std::int32_t>> buckets(static_cast<std::size_t>(n));
  for (std::int64_t i = 0; i < n; ++i) {
    std::uint64_t key = 0;
    for (int c = 0; c < 3; ++c) {
      const auto cell = static_cast<std::uint64_t>((mesh.nodes(c, i) - lo[c]) / extent * 1e8 + 0.3819660113);
      key = (key ^ cell) * 0x9E3779B97F4A7C15ULL;
      key ^= key >> 29;
    }
    buckets[static_cast<std::size_t>(i)] = {key, static_cast<std::int32_t>(i)};
  }
  std::sort(buckets.begin(), buckets.end());

  std::vector<Point> joint;
  for (auto begin = buckets.begin(); begin != buckets.end();) {
    const auto end = std::find_if(begin, buckets.end(), [&](const auto& b) { return b.first != begin->first; });
    if (end - begin > 1) {
      joint.clear();
      for (auto i = begin; i != end; ++i) {
        const Point own = normals.col(i->second);
        Point sum = Point::Zero();
        for (auto j = begin; j != end; ++j) {
          const Point other = normals.col(j->second);
          const bool is_same_place =
              (node_place(mesh, i->second) - node_place(mesh, j->second)).lpNorm<Eigen::Infinity>() <= 1e-12 * extent;
          if (i == j || (is_same_place && own.dot(other) > same_side_cosine)) sum += other;
        }
        joint.push_back(unit_or_zero(sum));
      }
      for (auto i = begin; i != end; ++i) normals.col(i->second) = joint[static_cast<std::size_t>(i - begin)];
    }
    begin = end;
  }
}

} // namespace

Eigen::Matrix3Xd nodal_normals(const SurfaceMesh& mesh)
{
  std::vector<Point> face_normals(static_cast<std::size_t>(mesh.n_faces()));
  const auto degenerate = degenerate_faces(mesh);
  Eigen::Matrix3Xd sums = Eigen::Matrix3Xd::Zero(3, mesh.n_nodes());
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    Point& normal = face_normals[static_cast<std::size_t>(f)];
    normal = Point::Zero();
    if (std::binary_search(degenerate.begin(), degenerate.end(), static_cast<std::int32_t>(f))) continue;
    normal = face_normal(mesh, f);
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const auto [next, previous] = edges_at(mesh, face, k);
      const double weight = next.squaredNorm() * previous.squaredNorm();
      if (weight > 0.0) sums.col(face[k]) += next.cross(previous) / weight; // 0: two nodes at one place, no angle
    }
  }

  // Nodes at edges: where a face looks away from the sum.
  std::vector<std::uint8_t> is_at_edge(static_cast<std::size_t>(mesh.n_nodes()), 0);
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    const Point& normal = face_normals[static_cast<std::size_t>(f)];
    if (normal.isZero(0.0)) continue;
    for (const auto node : mesh.face(f))
      if (sums.col(node).dot(normal) < smooth_cosine * sums.col(node).norm())
        is_at_edge[static_cast<std::size_t>(node)] = 1;
  }
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i)
    if (is_at_edge[static_cast<std::size_t>(i)] != 0) sums.col(i).setZero();
  for (std::int64_t f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t k = 0; k < face.size(); ++k) {
      if (is_at_edge[static_cast<std::size_t>(face[k])] == 0) continue;
      const auto [next, previous] = edges_at(mesh, face, k);
      const double angle = std::atan2(next.cross(previous).norm(), next.dot(previous));
      sums.col(face[k]) += angle * face_normals[static_cast<std::size_t>(f)];
    }
  }

  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i) sums.col(i) = unit_or_zero(sums.col(i));
  join_seams(mesh, sums);
  return sums;
}

} // namespace mullion::surface
