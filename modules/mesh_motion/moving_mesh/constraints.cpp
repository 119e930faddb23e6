#include "constraints.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace mullion::moving_mesh {
namespace {

/// Corners of the faces of an element in space; a triangle's last one is -1.
using Face = std::array<int, 4>;

std::vector<Face> faces_of_element(int dimension, std::size_t n)
{
  if (dimension == 2 && n == 3) return {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}};
  if (dimension == 2) return {{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}};
  if (n == 4) return {{0, 1, 2, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 2, 3, -1}};
  if (n == 5) return {{0, 1, 2, 3}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {0, 3, 4, -1}};
  if (n == 6) return {{0, 1, 2, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {0, 2, 5, 3}};
  return {{0, 1, 2, 3}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {0, 3, 7, 4}};
}

} // namespace

std::vector<std::vector<Index>> boundary_faces(const MovingMesh& mesh)
{
  std::vector<std::vector<Index>> all;
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    const auto element = mesh.element(e);
    for (const auto& face : faces_of_element(mesh.dimension, element.size())) {
      std::vector<Index> nodes;
      for (const int corner : face)
        if (corner >= 0) nodes.push_back(element[static_cast<std::size_t>(corner)]);
      std::sort(nodes.begin(), nodes.end());
      all.push_back(std::move(nodes));
    }
  }
  std::sort(all.begin(), all.end());
  std::vector<std::vector<Index>> once;
  for (std::size_t i = 0; i < all.size();) {
    std::size_t next = i + 1;
    while (next < all.size() && all[next] == all[i]) ++next;
    if (next == i + 1) once.push_back(all[i]);
    i = next;
  }
  return once;
}

Constraints constraints(const MovingMesh& mesh, std::span<const Index> wall_nodes, const std::vector<Side>& sides)
{
  Constraints result{IsGiven::Constant(mesh.dimension, mesh.nodes.cols(), false), std::vector<Index>(sides.size(), 0)};
  const Eigen::VectorXd lower = mesh.nodes.rowwise().minCoeff(), upper = mesh.nodes.rowwise().maxCoeff();
  // Coordinates come out of files and formulas: a billionth of the extent is no distance.
  const double near = 1e-9 * (upper - lower).maxCoeff();
  for (const auto& face : boundary_faces(mesh)) {
    bool may_move = false;
    for (std::size_t s = 0; s < sides.size(); ++s) {
      const auto [axis, is_upper, is_free] = sides[s];
      const double at = is_upper ? upper[axis] : lower[axis];
      if (!std::all_of(face.begin(), face.end(),
                       [&, a = axis](Index i) { return std::abs(mesh.nodes(a, i) - at) <= near; }))
        continue;
      may_move = true;
      ++result.n_faces[s];
      if (is_free) continue;
      for (const auto node : face) result.is_given(axis, node) = true;
    }
    if (!may_move)
      for (const auto node : face) result.is_given.col(node) = true;
  }
  for (const auto node : wall_nodes) result.is_given.col(node) = true;
  return result;
}

} // namespace mullion::moving_mesh
