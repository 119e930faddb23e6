// The boundary of a solid: which faces its elements have, how loads on them act on nodes, and where they point.
#pragma once

#include "solid.hpp"

#include <vector>

namespace mullion::elastic_solid {

/// A face by its element and its number among that element's faces.
struct FaceOf {
  Eigen::Index element = 0;
  int local = 0;
};

/// A surface: faces with outward right-hand-rule normals (in 2D to the right of the line), of the solid's nodes.
struct Surface {
  std::vector<Shape> shapes;                ///< of each face: line2, triangle3 or quadrilateral4
  std::vector<Eigen::VectorX<Index>> faces; ///< node numbers of each face
  std::vector<FaceOf> owners;               ///< of each face, where they are known
};

/// A surface from blocks of faces, one after the other; owners are not known.
[[nodiscard]] Surface surface_of_blocks(const std::vector<mesh_files::Block>& blocks);

/// The nodes of an element's faces, in outward order. @return local node numbers, a list a face
[[nodiscard]] const std::vector<std::vector<int>>& local_faces(Shape shape);

/// The faces with these owners.
[[nodiscard]] Surface surface_of(const Solid& solid, const std::vector<FaceOf>& owners);

/// Every face that belongs to one element only. In the order of the elements.
[[nodiscard]] std::vector<FaceOf> boundary_faces(const Solid& solid);

/// The nodes of a surface, ascending.
[[nodiscard]] std::vector<Index> nodes_of(const Surface& surface);

/// S_ij = int N_i N_j dA of all nodes, (n_nodes x n_nodes), by two Gauss points a direction: what makes loads of nodal
/// tractions, R = S t. In m of length in 2D, in m^2 in 3D.
/// @param nodes  (dimension x n_nodes) [m]
[[nodiscard]] SparseMatrix surface_mass(const Eigen::MatrixXd& nodes, const Surface& surface);

/// int N_i n dA of all nodes, (dimension x n_nodes): outward, as long as the length or area that belongs to the node.
[[nodiscard]] Eigen::MatrixXd nodal_normals(const Eigen::MatrixXd& nodes, const Surface& surface);

} // namespace mullion::elastic_solid
