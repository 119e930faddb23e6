// The formulas are those of geometry alone; element by element, nothing is kept.
#include "io/mesh_figures.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace mullion::io {
namespace {

using Points = Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 8>; ///< an element's nodes, in space
using Corner = std::array<std::uint8_t, 4>;                       ///< a corner and its neighbours along the edges
using Face = std::array<std::int8_t, 4>;                          ///< outward; -1: a triangle has no fourth node

struct ElementFacts {
  const char *one, *many;
  int dimension;
};
/// By MULLION_POINT1, ….
constexpr std::array<ElementFacts, 8> facts = {{{"point", "points", 0},
                                                {"line", "lines", 1},
                                                {"triangle", "triangles", 2},
                                                {"quadrilateral", "quadrilaterals", 2},
                                                {"tetrahedron", "tetrahedra", 3},
                                                {"pyramid", "pyramids", 3},
                                                {"prism", "prisms", 3},
                                                {"hexahedron", "hexahedra", 3}}};

constexpr std::array<Face, 4> tetrahedron_faces = {{{0, 2, 1, -1}, {0, 1, 3, -1}, {1, 2, 3, -1}, {0, 3, 2, -1}}};
constexpr std::array<Face, 5> pyramid_faces = {
    {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}}};
constexpr std::array<Face, 5> prism_faces = {{{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}};
constexpr std::array<Face, 6> hexahedron_faces = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

constexpr std::array<Corner, 4> quadrilateral_corners = {{{0, 1, 3, 0}, {1, 2, 0, 0}, {2, 3, 1, 0}, {3, 0, 2, 0}}};
constexpr std::array<Corner, 4> pyramid_corners = {{{0, 1, 3, 4}, {1, 2, 0, 4}, {2, 3, 1, 4}, {3, 0, 2, 4}}};
constexpr std::array<Corner, 6> prism_corners = {
    {{0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5}, {3, 5, 4, 0}, {4, 3, 5, 1}, {5, 4, 3, 2}}};
constexpr std::array<Corner, 8> hexahedron_corners = {
    {{0, 1, 3, 4}, {1, 2, 0, 5}, {2, 3, 1, 6}, {3, 0, 2, 7}, {4, 7, 5, 0}, {5, 4, 6, 1}, {6, 5, 7, 2}, {7, 6, 4, 3}}};

std::span<const Face> faces_of(std::uint32_t type)
{
  switch (type) {
  case MULLION_TETRAHEDRON4: return tetrahedron_faces;
  case MULLION_PYRAMID5: return pyramid_faces;
  case MULLION_PRISM6: return prism_faces;
  case MULLION_HEXAHEDRON8: return hexahedron_faces;
  default: return {};
  }
}

std::span<const Corner> corners_of(std::uint32_t type)
{
  switch (type) {
  case MULLION_QUADRILATERAL4: return quadrilateral_corners;
  case MULLION_PYRAMID5: return pyramid_corners;
  case MULLION_PRISM6: return prism_corners;
  case MULLION_HEXAHEDRON8: return hexahedron_corners;
  default: return {};
  }
}

/// The length of a vector along z; its sign only where surfaces lie in the plane and have an upper side.
double size_of(const Eigen::Vector3d& area, bool is_plane) { return is_plane ? area.z() : area.norm(); }

double measure_of(std::uint32_t type, const Points& x, bool is_plane)
{
  switch (type) {
  case MULLION_POINT1: return 0.0;
  case MULLION_LINE2: return (x.col(1) - x.col(0)).norm();
  case MULLION_TRIANGLE3:
    return 0.5 * size_of(Eigen::Vector3d(x.col(1) - x.col(0)).cross(Eigen::Vector3d(x.col(2) - x.col(0))), is_plane);
  case MULLION_QUADRILATERAL4:
    return 0.5 * size_of(Eigen::Vector3d(x.col(2) - x.col(0)).cross(Eigen::Vector3d(x.col(3) - x.col(1))), is_plane);
  default: break;
  }
  const Eigen::Vector3d centre = x.rowwise().mean();
  double volume = 0.0; // of the pyramids from the centre over the faces
  for (const auto& face : faces_of(type)) {
    const std::size_t n = face[3] < 0 ? 3 : 4;
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < n; ++k) middle += x.col(face[k]) / static_cast<double>(n);
    for (std::size_t k = 0; k < n; ++k) {
      const Eigen::Vector3d a = x.col(face[k]) - centre, b = x.col(face[(k + 1) % n]) - centre;
      volume += a.cross(b).dot(middle - centre) / 6.0;
    }
  }
  return volume;
}

double shape_of(std::uint32_t type, const Points& x, bool is_plane)
{
  if (facts[type].dimension < 2) return 1.0;
  if (type == MULLION_TRIANGLE3 || type == MULLION_TETRAHEDRON4) {
    double squares = 0.0;
    for (Eigen::Index i = 0; i < x.cols(); ++i)
      for (Eigen::Index j = i + 1; j < x.cols(); ++j) squares += (x.col(i) - x.col(j)).squaredNorm();
    if (!(squares > 0.0)) return 0.0; // all in one point
    const double measure = measure_of(type, x, is_plane), root = std::sqrt(3.0);
    return type == MULLION_TRIANGLE3 ? 4.0 * root * measure / squares : 72.0 * root * measure / std::pow(squares, 1.5);
  }
  double smallest = 1.0;
  for (const auto& corner : corners_of(type)) {
    const auto edge = [&](std::size_t k) -> Eigen::Vector3d { return x.col(corner[k]) - x.col(corner[0]); };
    const bool is_volume = facts[type].dimension == 3;
    const Eigen::Vector3d area = edge(1).cross(edge(2));
    const double lengths = edge(1).norm() * edge(2).norm() * (is_volume ? edge(3).norm() : 1.0);
    const double measure = is_volume ? area.dot(edge(3)) : size_of(area, is_plane);
    smallest = std::min(smallest, lengths > 0.0 ? measure / lengths : 0.0);
  }
  return smallest;
}

std::string place(const Eigen::Vector3d& x, std::uint32_t dimension)
{
  if (dimension == 1) return fmt::format("{:.6g}", x[0]);
  return dimension == 2 ? fmt::format("({:.6g}, {:.6g})", x[0], x[1])
                        : fmt::format("({:.6g}, {:.6g}, {:.6g})", x[0], x[1], x[2]);
}

} // namespace

MeshFigures figures_of(const PaneData& pane, const double* coordinates)
{
  MeshFigures figures;
  const auto d = static_cast<Eigen::Index>(pane.dimension);
  figures.dimension = pane.dimension;
  figures.n_nodes = pane.n_nodes;
  const Eigen::Map<const Eigen::MatrixXd> nodes(coordinates, d, pane.n_nodes);
  if (pane.n_nodes > 0) {
    figures.low.head(d) = nodes.rowwise().minCoeff();
    figures.high.head(d) = nodes.rowwise().maxCoeff();
  }
  for (const auto& block : pane.blocks)
    if (block.n_elements > 0)
      figures.element_dimension = std::max(figures.element_dimension, facts[block.element].dimension);
  bool is_first = true;
  for (const auto& block : pane.blocks) {
    if (block.n_elements == 0) continue;
    const auto& names = facts[block.element];
    figures.elements.emplace_back(block.n_elements == 1 ? names.one : names.many, block.n_elements);
    if (names.dimension < figures.element_dimension) continue;
    Points x = Points::Zero(3, block.nodes_per_element);
    for (std::int64_t e = 0; e < block.n_elements; ++e) {
      for (std::uint32_t k = 0; k < block.nodes_per_element; ++k)
        x.col(k).head(d) = nodes.col(block.connectivity[e * block.nodes_per_element + k]);
      const Eigen::Vector3d at = x.rowwise().mean();
      const double measure = measure_of(block.element, x, pane.dimension == 2);
      const double shape = shape_of(block.element, x, pane.dimension == 2);
      // Negated, so that what is not a number is found, too.
      if (is_first || !(measure >= figures.smallest.value)) figures.smallest = {measure, at};
      if (is_first || !(measure <= figures.largest.value)) figures.largest = {measure, at};
      if (is_first || !(shape >= figures.worst.value)) figures.worst = {shape, at};
      is_first = false;
    }
  }
  return figures;
}

std::string describe(const MeshFigures& f)
{
  std::string text = fmt::format("{} node{}", f.n_nodes, f.n_nodes == 1 ? "" : "s");
  for (const auto& [name, n] : f.elements) text += fmt::format(", {} {}", n, name);
  text += '\n';
  if (f.n_nodes > 0)
    text += fmt::format("  extent          {} to {} m\n", place(f.low, f.dimension), place(f.high, f.dimension));
  if (f.elements.empty() || f.element_dimension == 0) return text;
  const char* unit = f.element_dimension == 1 ? "m" : f.element_dimension == 2 ? "m^2" : "m^3";
  if (f.largest.value - f.smallest.value <= 1e-9 * std::abs(f.largest.value)) // beyond that it is round-off
    text += fmt::format("  each cell       {:.6g} {}\n", f.smallest.value, unit);
  else
    text +=
        fmt::format("  smallest cell   {:.6g} {} at {}\n  largest cell    {:.6g} {} at {}\n", f.smallest.value, unit,
                    place(f.smallest.at, f.dimension), f.largest.value, unit, place(f.largest.at, f.dimension));
  if (f.element_dimension > 1)
    text +=
        fmt::format("  worst shape     {:.4g} at {} (1 is the best)\n", f.worst.value, place(f.worst.at, f.dimension));
  return text;
}

} // namespace mullion::io
