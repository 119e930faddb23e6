// The mesh as the finite-volume scheme sees it: cells, and faces between them with an owner and a neighbour. Built
// once from blocks of elements; knows no coordinates afterwards, so that it serves a moving mesh unchanged.
#pragma once

#include "files/mesh_file.hpp"
#include "gas.hpp"

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace mullion::euler {

using mesh_files::Block;
using mesh_files::Connectivity;
using mesh_files::Index;
using mesh_files::Shape;

/// The mesh cannot be used; the text says where and why.
class MeshError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

template <int D> inline constexpr int most_face_nodes = D == 2 ? 2 : 4;
template <int D> inline constexpr int most_cell_faces = D == 2 ? 4 : 6;

/// The faces of a shape, by the numbers of their nodes within the element; by the right-hand rule (in the plane: from
/// first to second node, the outside on the right) their normals point out of it. -1 fills up.
struct ShapeFaces {
  int n_faces = 0;
  std::array<std::array<int, 4>, 6> nodes{};
};
/// @throws MeshError for a shape that is no cell in this dimension
const ShapeFaces& faces_of(Shape shape, int dimension);

/// Nodes of a face, outward for its owner; -1 fills up.
template <int D> using FaceNodes = std::array<Index, most_face_nodes<D>>;

/// Two patches that are the same place: what leaves through one enters through the other.
struct PeriodicPair {
  int first = 0, second = 0; ///< numbers of patches
};

/// Which face of which cell, as the blocks count: cells through the blocks in their order.
struct CellFace {
  Index cell = 0;
  int face = 0;
};

template <int D> struct BoundaryFace {
  Index face = 0;  ///< number of the face
  Index cell = 0;  ///< its owner
  int patch = 0;   ///< whose condition holds
  CellFace origin; ///< as the blocks count
};

/// Cells have numbers of their own here, such that neighbours lie close together in memory; `order` leads back.
template <int D> struct Mesh {
  std::size_t n_nodes = 0, n_cells = 0, n_faces = 0;
  std::vector<Index> order; ///< of each cell: its number as the blocks count

  // The faces of owner c are face_begin[c] … face_begin[c + 1]; an owner has the lower number.
  std::vector<Index> face_begin;
  std::vector<Index> owner;     ///< of each face
  std::vector<Index> neighbour; ///< of each face: a cell, or -1 - (number of the boundary face)
  std::vector<FaceNodes<D>> face_nodes;
  std::vector<BoundaryFace<D>> boundary; ///< by number of their faces

  // All faces of a cell, owned or not, ascending: 2 * face, + 1 where the cell is the neighbour.
  std::vector<Index> cell_face_begin, cell_faces;

  // The cells that a gradient is computed from: over faces for quadrilaterals, hexahedra and the like; all that
  // share a node for triangles and tetrahedra, whose faces are too few.
  std::vector<Index> stencil_begin, stencil;

  // Where a neighbour is seen across a periodic boundary: it lies at its place plus the shift. Empty: nowhere.
  // shifts[0] is zero.
  std::vector<Vec<D>> shifts;
  std::vector<std::uint8_t> face_shift, stencil_shift;

  [[nodiscard]] bool is_periodic() const { return !face_shift.empty(); }
  /// @param b  number of a boundary face
  [[nodiscard]] const FaceNodes<D>& boundary_nodes(Index b) const
  {
    return face_nodes[static_cast<std::size_t>(boundary[static_cast<std::size_t>(b)].face)];
  }
};

/// What a mesh is built from.
template <int D> struct MeshSource {
  Eigen::Matrix<double, D, Eigen::Dynamic> nodes; ///< [m]
  std::vector<Block> blocks;
  /// (most_cell_faces x cells) patch of each face of each cell, -1 within the mesh
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic> patch_of_face;
  std::vector<PeriodicPair> periodic;
};

/// @throws MeshError: a face of more than two cells, a face on the boundary without a patch, periodic patches that
///         do not fit onto each other
template <int D> Mesh<D> build_mesh(const MeshSource<D>& source);

} // namespace mullion::euler
