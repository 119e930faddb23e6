#include "quality.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace mullion::moving_mesh {
namespace {

/// A corner of an element and its neighbours along the edges there, as a left-handed turn in the plane and a
/// right-handed triple in space.
using Corner = std::array<std::uint8_t, 4>;

constexpr std::array<Corner, 4> quadrilateral = {{{0, 1, 3, 0}, {1, 2, 0, 0}, {2, 3, 1, 0}, {3, 0, 2, 0}}};
constexpr std::array<Corner, 4> pyramid = {{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
constexpr std::array<Corner, 6> prism = {
    {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<Corner, 8> hexahedron = {
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

std::span<const Corner> corners_of(int dimension, std::size_t n)
{
  if (dimension == 2) return quadrilateral;
  if (n == 5) return pyramid;
  if (n == 6) return prism;
  return hexahedron;
}

double shape_of_simplex(const Eigen::MatrixXd& coordinates, std::span<const Index> element)
{
  double squares = 0.0;
  for (std::size_t i = 0; i < element.size(); ++i)
    for (std::size_t j = i + 1; j < element.size(); ++j)
      squares += (coordinates.col(element[i]) - coordinates.col(element[j])).squaredNorm();
  const double measure = simplex_measure(coordinates, element, {0, 1, 2, 3});
  if (!(squares > 0.0)) return 0.0; // all in one point
  const double root = std::sqrt(3.0);
  return element.size() == 3 ? 4.0 * root * measure / squares : 72.0 * root * measure / std::pow(squares, 1.5);
}

double scaled_jacobian(const Eigen::MatrixXd& coordinates, std::span<const Index> element, const Corner& corner)
{
  const auto d = coordinates.rows();
  const auto edge = [&](std::size_t k) -> Eigen::VectorXd {
    return coordinates.col(element[corner[k]]) - coordinates.col(element[corner[0]]);
  };
  if (d == 2) {
    const Eigen::Vector2d u = edge(1), v = edge(2);
    const double lengths = u.norm() * v.norm();
    return lengths > 0.0 ? (u[0] * v[1] - u[1] * v[0]) / lengths : 0.0;
  }
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = edge(static_cast<std::size_t>(k) + 1);
  const double lengths = edges.colwise().norm().prod();
  return lengths > 0.0 ? edges.determinant() / lengths : 0.0;
}

} // namespace

double shape_of_element(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates, Index e)
{
  const auto element = mesh.element(e);
  if (element.size() == static_cast<std::size_t>(mesh.dimension) + 1) return shape_of_simplex(coordinates, element);
  double smallest = 1.0;
  for (const auto& corner : corners_of(mesh.dimension, element.size()))
    smallest = std::min(smallest, scaled_jacobian(coordinates, element, corner));
  return smallest;
}

Quality quality_of(const MovingMesh& mesh, const std::vector<double>& reference, const Eigen::MatrixXd& coordinates)
{
  Quality quality{.min_area_ratio = 1e300, .min_shape = 1e300, .folded_ratio = 1e300};
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    const auto element = mesh.element(e);
    const double before = reference[static_cast<std::size_t>(e)];
    const auto [simplices, weight] = parts_of_element(mesh.dimension, element.size());
    double measure = 0.0;
    for (const auto& corners : simplices) {
      const double part = simplex_measure(coordinates, element, corners);
      measure += weight * part;
      if (!(part > 0.0) && !(part / before >= quality.folded_ratio)) { // also if it is not a number
        quality.is_folded = true;
        quality.folded = e;
        quality.folded_ratio = part / before;
      }
    }
    if (measure / before < quality.min_area_ratio) {
      quality.min_area_ratio = measure / before;
      quality.smallest = e;
    }
    const double shape = shape_of_element(mesh, coordinates, e);
    if (shape < quality.min_shape) {
      quality.min_shape = shape;
      quality.worst = e;
    }
  }
  return quality;
}

} // namespace mullion::moving_mesh
