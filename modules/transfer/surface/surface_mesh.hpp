// One side of an interface as the transfer kernels see it: nodes and faces in the reference configuration, plain data,
// with the measures of a face that everything else is built from. Where a mesh comes from, a window say, is not known
// here.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry> // cross() of points

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mullion::surface {

/// A place in space [m]; in 2D the third coordinate is zero, so that most kernels need not ask for the dimension.
using Point = Eigen::Vector3d;

/// One side of an interface in its reference configuration: a polyline in 2D, a surface of triangles and
/// quadrilaterals in 3D. Plain data.
///
/// Normals follow the right-hand rule; in 2D the normal of a face is (dy, -dx) of its direction. The two sides of an
/// interface may have opposite orientation (each points out of its own body) or the same.
struct SurfaceMesh {
  int dimension = 3;                    ///< of space: 2 (faces are lines) or 3
  Eigen::MatrixXd nodes;                ///< (dimension x n_nodes) [m]
  std::vector<std::int32_t> face_begin; ///< (n_faces + 1) where each face's nodes begin in face_nodes
  std::vector<std::int32_t> face_nodes; ///< node numbers; a quadrilateral's in order around it

  [[nodiscard]] std::int64_t n_nodes() const { return nodes.cols(); }
  [[nodiscard]] std::int64_t n_faces() const
  {
    return face_begin.empty() ? 0 : static_cast<std::int64_t>(face_begin.size()) - 1;
  }
  [[nodiscard]] std::span<const std::int32_t> face(std::int64_t f) const
  {
    const auto begin = static_cast<std::size_t>(face_begin[static_cast<std::size_t>(f)]);
    const auto end = static_cast<std::size_t>(face_begin[static_cast<std::size_t>(f) + 1]);
    return std::span(face_nodes).subspan(begin, end - begin);
  }
};

/// A mesh from blocks of elements, one after the other: anything with a `connectivity` (nodes of a face x faces).
/// @param nodes  (dimension x nodes) [m]
template <class Blocks> SurfaceMesh mesh_of_blocks(const Eigen::MatrixXd& nodes, const Blocks& blocks)
{
  SurfaceMesh mesh;
  mesh.dimension = static_cast<int>(nodes.rows());
  mesh.nodes = nodes;
  mesh.face_begin.push_back(0);
  for (const auto& block : blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) {
      for (Eigen::Index k = 0; k < block.connectivity.rows(); ++k) mesh.face_nodes.push_back(block.connectivity(k, e));
      mesh.face_begin.push_back(static_cast<std::int32_t>(mesh.face_nodes.size()));
    }
  return mesh;
}

/// What is wrong with a mesh, in words that name the place; "" if nothing is.
///
/// Dimension and shapes, node numbers in range, nodes per face (2 in 2D, 3 or 4 in 3D), finite coordinates, no node
/// twice in a face, not all faces degenerate, and in 2D one direction along each polyline (a node that ends two faces
/// or begins two is an error, one that three or more share is a branch and allowed).
[[nodiscard]] std::string complaint_about(const SurfaceMesh& mesh);

/// Place of a node [m].
[[nodiscard]] Point node_position(const SurfaceMesh& mesh, std::int64_t node);

/// Mean of a face's nodes [m].
[[nodiscard]] Point face_centre(const SurfaceMesh& mesh, std::int64_t f);

/// Length [m] of a line, area [m^2] of a triangle or quadrilateral. A warped quadrilateral has the area that the 2 x 2
/// Gauss rule gives, which is exact for a plane one.
[[nodiscard]] double face_measure(const SurfaceMesh& mesh, std::int64_t f);

/// Unit normal; a quadrilateral's is that of the cross product of its diagonals. Zero for a degenerate face.
[[nodiscard]] Point face_normal(const SurfaceMesh& mesh, std::int64_t f);

/// Characteristic size of a face [m]: its length, or the root of its area.
[[nodiscard]] double face_size(const SurfaceMesh& mesh, std::int64_t f);

/// Mean of face_size() over all faces [m]; 0 without faces.
[[nodiscard]] double mean_face_size(const SurfaceMesh& mesh);

/// Sum of face_measure() over all faces [m or m^2].
[[nodiscard]] double total_measure(const SurfaceMesh& mesh);

/// Faces without area, in ascending order: a measure below 1e-12 of the mean one. Overlays skip them.
[[nodiscard]] std::vector<std::int32_t> degenerate_faces(const SurfaceMesh& mesh);

/// "face 3 at (0.1, 0.2) m", for messages.
[[nodiscard]] std::string place_of_face(const SurfaceMesh& mesh, std::int64_t f);

/// "node 3 at (0.1, 0.2) m", for messages.
[[nodiscard]] std::string place_of_node(const SurfaceMesh& mesh, std::int64_t node);

} // namespace mullion::surface
