// From a mesh with named groups to what a solid's windows hold: its elements, its wet surface, which nodes are held,
// and which faces carry a given load. What is wrong with the groups is a FileError that names them.
#pragma once

#include "boundary.hpp"

#include "files/mesh_file.hpp"

#include <string>
#include <vector>

namespace mullion::elastic_solid {

/// Lists of groups as a case names them: "a, b"; "" for none.
struct GroupTexts {
  std::string wet, clamped, roller_x, roller_y, roller_z, prescribed, edge_load;
};

/// Bits of `constraints`: held along x, y, z; moved along all of them.
inline constexpr Index held_bits[] = {1, 2, 4};
inline constexpr Index prescribed_bit = 8;

struct Body {
  Eigen::MatrixXd nodes;                 ///< (dimension x n_nodes) [m]
  std::vector<mesh_files::Block> blocks; ///< elements as large as the space
  std::vector<Index> wet_nodes;          ///< ascending
  std::vector<mesh_files::Block> wet;    ///< outward faces, of the wet nodes by their place in wet_nodes
  Eigen::VectorX<Index> constraints;     ///< of the nodes, sums of bits
  Eigen::VectorX<Index> loaded_faces;    ///< of the elements: sum of 2^k for each face k in the groups `edge_load`
};

/// "a, b" as {"a", "b"}; "" as {}.
[[nodiscard]] std::vector<std::string> names_in(const std::string& text);

/// @throws FileError, beginning with the key of the list: an unknown group (with the names that there are), an element
/// of a surface that is no face on the boundary of the solid, no wet surface; or complaint_about() the solid
[[nodiscard]] Body body_of(const mesh_files::MeshFile& mesh, const GroupTexts& groups);

/// The faces that a sum of bits for each element stands for.
[[nodiscard]] std::vector<FaceOf> faces_in(const Eigen::VectorX<Index>& loaded_faces);

} // namespace mullion::elastic_solid
