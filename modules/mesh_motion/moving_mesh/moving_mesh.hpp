// The mesh of a gas whose wall moves, as the kernels of mesh motion see it: plain data, and the simplices (triangles,
// tetrahedra) that its elements are taken apart into. Where a mesh comes from, a window say, is not known here.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mullion::moving_mesh {

using Index = std::int32_t;

/// Elements that fill a domain: triangles and quadrilaterals in the plane; tetrahedra, pyramids, prisms and hexahedra
/// in space. Within a dimension the number of nodes tells which one an element is; the order of the nodes is Gmsh's.
struct MovingMesh {
  int dimension = 2;        ///< of space, and of the elements: 2 or 3
  Eigen::MatrixXd nodes;    ///< (dimension x n_nodes) reference coordinates [m]
  std::vector<Index> begin; ///< (n_elements + 1) where each element's nodes begin in element_nodes
  std::vector<Index> element_nodes;

  [[nodiscard]] Index n_elements() const { return begin.empty() ? 0 : static_cast<Index>(begin.size()) - 1; }
  [[nodiscard]] std::span<const Index> element(Index e) const
  {
    const auto first = static_cast<std::size_t>(begin[static_cast<std::size_t>(e)]);
    return std::span(element_nodes)
        .subspan(first, static_cast<std::size_t>(begin[static_cast<std::size_t>(e) + 1]) - first);
  }
};

/// A mesh from blocks of elements, one after the other: anything with a `connectivity` (nodes of an element x
/// elements). @param nodes  (dimension x nodes) [m]
template <class Blocks> MovingMesh mesh_of_blocks(const Eigen::MatrixXd& nodes, const Blocks& blocks)
{
  MovingMesh mesh{static_cast<int>(nodes.rows()), nodes, {0}, {}};
  for (const auto& block : blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) {
      for (Eigen::Index k = 0; k < block.connectivity.rows(); ++k)
        mesh.element_nodes.push_back(block.connectivity(k, e));
      mesh.begin.push_back(static_cast<Index>(mesh.element_nodes.size()));
    }
  return mesh;
}

/// An element taken apart into simplices. A quadrilateral is cut along one diagonal, and along the other, and each of
/// the four triangles counts half; likewise in space, where each face with four corners is cut both ways. So the parts
/// on either side of a face always fit together, and no diagonal is preferred.
struct Parts {
  std::span<const std::array<std::uint8_t, 4>> simplices; ///< corners, in the plane three of them; orientation kept
  double weight = 0.0;                                    ///< of each
};

/// @param n  nodes of the element; a number that no element has gives no parts
Parts parts_of_element(int dimension, std::size_t n);

/// Signed area or volume of a simplex [m^2 or m^3]. @param coordinates  (dimension x nodes) [m]
double simplex_measure(const Eigen::MatrixXd& coordinates, std::span<const Index> element,
                       const std::array<std::uint8_t, 4>& corners);

/// Area or volume of each element [m^2 or m^3].
std::vector<double> element_measures(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates);

/// Mean of an element's nodes [m].
Eigen::VectorXd element_centre(const MovingMesh& mesh, const Eigen::MatrixXd& coordinates, Index e);

/// What is wrong with a mesh, in words that name the place; "" if nothing is: dimension and elements as above, node
/// numbers in range, and no part of an element turned over or without extent.
[[nodiscard]] std::string complaint_about(const MovingMesh& mesh);

} // namespace mullion::moving_mesh
