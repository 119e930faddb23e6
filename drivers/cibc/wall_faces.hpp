// The fluid's wall as CIBC sees it: faces, each with its nodes, and means from the one to the other. Along a wall that
// bends, the formulas of corrections.hpp hold face by face, along each face's normal; motion lives on nodes. In one
// dimension a face is its node and every mean is the value itself, to the bit.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace mullion::cibc {

using Faces = Eigen::Matrix<std::int32_t, Eigen::Dynamic, Eigen::Dynamic>; ///< (nodes x faces) of one shape

struct WallFaces {
  std::vector<Faces> blocks;           ///< points, lines, triangles, quadrilaterals
  std::vector<double> measures;        ///< of each face, in their order: 1, [m] or [m^2]
  std::vector<std::uint8_t> is_at_rim; ///< of each node
};

namespace detail {
inline double measure_of(const Eigen::MatrixXd& x, const Faces& block, Eigen::Index f)
{
  const auto node = [&](Eigen::Index k) -> Eigen::Vector3d {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    p.head(x.rows()) = x.col(block(k, f));
    return p;
  };
  if (block.rows() == 1) return 1.0;
  if (block.rows() == 2) return (node(1) - node(0)).norm();
  if (block.rows() == 3) return 0.5 * (node(1) - node(0)).cross(node(2) - node(0)).norm();
  return 0.5 * (node(2) - node(0)).cross(node(3) - node(1)).norm();
}
} // namespace detail

/// @param x       (dimension x n_nodes) reference coordinates [m]
/// @param blocks  the wall's faces; rim nodes are those of an edge that has one face only (in 2D: the ends)
inline WallFaces wall_faces(const Eigen::MatrixXd& x, std::vector<Faces> blocks)
{
  WallFaces wall{std::move(blocks), {}, std::vector<std::uint8_t>(static_cast<std::size_t>(x.cols()), 0)};
  std::vector<std::pair<std::int32_t, std::int32_t>> edges; // in 2D (node, node): an end is a node met once
  for (const auto& block : wall.blocks)
    for (Eigen::Index f = 0; f < block.cols(); ++f) {
      wall.measures.push_back(detail::measure_of(x, block, f));
      const auto n = block.rows();
      if (n == 2)
        for (Eigen::Index k = 0; k < 2; ++k) edges.emplace_back(block(k, f), block(k, f));
      for (Eigen::Index k = 0; n > 2 && k < n; ++k)
        edges.push_back(std::minmax<std::int32_t>({block(k, f), block((k + 1) % n, f)}));
    }
  std::sort(edges.begin(), edges.end());
  for (std::size_t first = 0, next; first < edges.size(); first = next) {
    next = first + 1;
    while (next < edges.size() && edges[next] == edges[first]) ++next;
    if (next - first > 1) continue;
    wall.is_at_rim[static_cast<std::size_t>(edges[first].first)] = 1;
    wall.is_at_rim[static_cast<std::size_t>(edges[first].second)] = 1;
  }
  return wall;
}

/// Mean over each face's nodes. @param on_nodes (components x n_nodes) @return (components x n_faces)
template <class Nodal> Eigen::MatrixXd mean_on_faces(const WallFaces& wall, const Nodal& on_nodes)
{
  Eigen::MatrixXd on_faces(on_nodes.rows(), static_cast<Eigen::Index>(wall.measures.size()));
  Eigen::Index face = 0;
  for (const auto& block : wall.blocks)
    for (Eigen::Index f = 0; f < block.cols(); ++f, ++face) {
      Eigen::VectorXd sum = on_nodes.col(block(0, f));
      for (Eigen::Index k = 1; k < block.rows(); ++k) sum += on_nodes.col(block(k, f));
      on_faces.col(face) = sum / static_cast<double>(block.rows());
    }
  return on_faces;
}

/// Mean over each node's faces, weighted by their measures. @param on_faces (components x n_faces)
template <class Facial> Eigen::MatrixXd mean_on_nodes(const WallFaces& wall, const Facial& on_faces)
{
  const auto n_nodes = static_cast<Eigen::Index>(wall.is_at_rim.size());
  Eigen::MatrixXd on_nodes = Eigen::MatrixXd::Zero(on_faces.rows(), n_nodes);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(n_nodes);
  Eigen::Index face = 0;
  for (const auto& block : wall.blocks)
    for (Eigen::Index f = 0; f < block.cols(); ++f, ++face)
      for (Eigen::Index k = 0; k < block.rows(); ++k) {
        const double measure = wall.measures[static_cast<std::size_t>(face)];
        on_nodes.col(block(k, f)) += measure * on_faces.col(face);
        weight(block(k, f)) += measure;
      }
  for (Eigen::Index i = 0; i < n_nodes; ++i) on_nodes.col(i) /= weight(i);
  return on_nodes;
}

} // namespace mullion::cibc
