#include "moving_mesh.hpp"

#include <Eigen/LU>

#include <sstream>

namespace mullion::moving_mesh {
namespace {

using Corners = std::array<std::uint8_t, 4>;

constexpr std::array<Corners, 1> triangle = {{{0, 1, 2, 0}}};
constexpr std::array<Corners, 4> quadrilateral = {{{0, 1, 2, 0}, {0, 2, 3, 0}, {0, 1, 3, 0}, {1, 2, 3, 0}}};
constexpr std::array<Corners, 1> tetrahedron = {{{0, 1, 2, 3}}};
constexpr std::array<Corners, 4> pyramid = {{{0, 1, 2, 4}, {0, 2, 3, 4}, {0, 1, 3, 4}, {1, 2, 3, 4}}};
constexpr std::array<Corners, 6> prism = {
    {{0, 1, 2, 5}, {0, 1, 5, 4}, {0, 4, 5, 3}, {0, 1, 2, 3}, {1, 2, 3, 4}, {2, 3, 4, 5}}};
// Four corners cut off, and what is left in the middle; then the other four.
constexpr std::array<Corners, 10> hexahedron = {{{0, 1, 2, 5},
                                                 {0, 2, 3, 7},
                                                 {0, 5, 7, 4},
                                                 {2, 7, 5, 6},
                                                 {0, 2, 7, 5},
                                                 {0, 1, 3, 4},
                                                 {1, 2, 3, 6},
                                                 {1, 6, 4, 5},
                                                 {3, 4, 6, 7},
                                                 {1, 3, 4, 6}}};

} // namespace

Parts parts_of_element(int dimension, std::size_t n)
{
  if (dimension == 2 && n == 3) return {triangle, 1.0};
  if (dimension == 2 && n == 4) return {quadrilateral, 0.5};
  if (dimension == 3 && n == 4) return {tetrahedron, 1.0};
  if (dimension == 3 && n == 5) return {pyramid, 0.5};
  if (dimension == 3 && n == 6) return {prism, 0.5};
  if (dimension == 3 && n == 8) return {hexahedron, 0.5};
  return {};
}

double simplex_measure(const Eigen::MatrixXd& coordinates, std::span<const Index> element, const Corners& corners)
{
  const auto x = [&](int k) { return coordinates.col(element[corners[static_cast<std::size_t>(k)]]); };
  if (coordinates.rows() == 2) {
    const Eigen::Vector2d u = x(1) - x(0), v = x(2) - x(0);
    return 0.5 * (u[0] * v[1] - u[1] * v[0]);
  }
  Eigen::Matrix3d edges;
  for (int k = 0; k < 3; ++k) edges.col(k) = x(k + 1) - x(0);
  return edges.determinant() / 6.0;
}

std::vector<double> element_measures(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates)
{
  std::vector<double> measures;
  measures.reserve(static_cast<std::size_t>(mesh.n_elements()));
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    const auto element = mesh.element(e);
    const auto [simplices, weight] = parts_of_element(mesh.dimension, element.size());
    double sum = 0.0;
    for (const auto& corners : simplices) sum += weight * simplex_measure(coordinates, element, corners);
    measures.push_back(sum);
  }
  return measures;
}

Eigen::VectorXd element_centre(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates, Index e)
{
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(coordinates.rows());
  for (const auto node : mesh.element(e)) sum += coordinates.col(node);
  return sum / static_cast<double>(mesh.element(e).size());
}

std::string complaint_about(const MovingMesh& mesh)
{
  std::ostringstream text;
  if (mesh.dimension != 2 && mesh.dimension != 3) {
    text << "a mesh in " << mesh.dimension << " dimensions; it has 2 or 3";
    return text.str();
  }
  if (mesh.n_elements() == 0) return "a mesh without elements";
  for (Index e = 0; e < mesh.n_elements(); ++e) {
    const auto element = mesh.element(e);
    const auto parts = parts_of_element(mesh.dimension, element.size());
    if (parts.simplices.empty()) {
      text << "element " << e << " has " << element.size() << " nodes; elements that fill "
           << (mesh.dimension == 2 ? "the plane have 3 or 4" : "space have 4, 5, 6 or 8");
      return text.str();
    }
    for (const auto node : element)
      if (node < 0 || node >= mesh.nodes.cols()) {
        text << "element " << e << " has the node " << node << "; there are " << mesh.nodes.cols();
        return text.str();
      }
    for (const auto& corners : parts.simplices)
      if (!(simplex_measure(mesh.nodes, element, corners) > 0.0)) {
        text << "element " << e << " around ("
             << element_centre(mesh, mesh.nodes, e).transpose().format({6, Eigen::DontAlignCols, ", ", ", "})
             << ") is folded or turned over; all elements turn to the left and are convex";
        return text.str();
      }
  }
  return "";
}

} // namespace mullion::moving_mesh
