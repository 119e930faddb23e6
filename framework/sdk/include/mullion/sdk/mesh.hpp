// Meshes as a module hands them over and gets them back: panes of nodes and blocks of elements, mixed types
// allowed. Plain data; the copy that counts lives in the window.
#pragma once

#include <mullion/sdk/abi.h>
#include <mullion/sdk/error.hpp>
#include <mullion/sdk/field.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace mullion {

enum class ElementType : std::uint32_t {
  point1 = MULLION_POINT1,
  line2 = MULLION_LINE2,
  triangle3 = MULLION_TRIANGLE3,
  quadrilateral4 = MULLION_QUADRILATERAL4,
  tetrahedron4 = MULLION_TETRAHEDRON4,
  pyramid5 = MULLION_PYRAMID5,
  prism6 = MULLION_PRISM6,
  hexahedron8 = MULLION_HEXAHEDRON8
};

/// Nodes of one element of this type; 0 for an unknown type.
constexpr std::uint32_t nodes_per_element(std::uint32_t element)
{
  constexpr std::uint32_t nodes[] = {1, 2, 3, 4, 4, 5, 6, 8};
  return element < 8 ? nodes[element] : 0;
}

using Coordinates = Eigen::MatrixXd;                                       ///< (dimension x n_nodes) [m]
using Connectivity = Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic>; ///< (nodes x elements), 0-based

/// Elements of one type within a pane.
struct Block {
  ElementType type;
  Connectivity connectivity;
};

/// One block of a window's mesh that a module owns. Elements count through the blocks in their order.
struct Pane {
  std::int64_t id = 0;
  Coordinates coordinates;
  std::vector<Block> blocks;

  [[nodiscard]] std::int64_t n_elements() const
  {
    std::int64_t n = 0;
    for (const auto& block : blocks) n += block.connectivity.cols();
    return n;
  }
};

/// A chain of equal-type line elements through the nodes in their order: the usual 1D mesh.
inline Pane line_pane(const Coordinates& coordinates, std::int64_t id = 0)
{
  const auto n = coordinates.cols();
  MULLION_REQUIRE(n >= 2, Errc::shape, "a line mesh needs at least two nodes, found {}", n);
  Connectivity lines(2, n - 1);
  for (Eigen::Index e = 0; e + 1 < n; ++e) lines.col(e) << static_cast<Index>(e), static_cast<Index>(e + 1);
  return {id, coordinates, {{ElementType::line2, lines}}};
}

/// Points only, one element a node: the wall of a 1D problem, or a cloud.
inline Pane point_pane(const Coordinates& coordinates, std::int64_t id = 0)
{
  Connectivity points(1, coordinates.cols());
  for (Eigen::Index i = 0; i < coordinates.cols(); ++i) points(0, i) = static_cast<Index>(i);
  return {id, coordinates, {{ElementType::point1, points}}};
}

/// A copy of what the C boundary describes.
inline Pane to_pane(const mullion_pane& raw)
{
  Pane pane{raw.id, Eigen::Map<const Eigen::MatrixXd>(raw.coordinates, raw.dimension, raw.n_nodes), {}};
  for (std::uint32_t b = 0; b < raw.n_blocks; ++b) {
    const auto& block = raw.blocks[b];
    pane.blocks.push_back(
        {static_cast<ElementType>(block.element),
         Eigen::Map<const Connectivity>(block.connectivity, block.nodes_per_element, block.n_elements)});
  }
  return pane;
}

} // namespace mullion
