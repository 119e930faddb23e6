// How two polylines are cut into smooth pieces that belong together: corners and ends of either side, which of them are
// the same, and the chains of faces between those. For the 2D overlay, which treats one chain at a time.
#pragma once

#include "surface_mesh.hpp"

#include <cstdint>
#include <vector>

namespace mullion::surface {

/// Where each node of a polyline begins and ends faces, and whether it is a corner or an end.
struct PolylineNodes {
  std::vector<std::int32_t> next_face;     ///< that begins in the node; -1: none
  std::vector<std::int32_t> previous_face; ///< that ends in the node; -1: none
  std::vector<bool> is_passage;            ///< exactly one face ends in it and one begins
  std::vector<std::int32_t> features;      ///< corners, ends and branches, in ascending order
};

/// Corners are nodes in which the direction turns by more than the angle; ends and branches are features too.
///
/// @param feature_angle  [rad]
/// @pre  complaint_about(mesh) == "", dimension 2
[[nodiscard]] PolylineNodes polyline_nodes(const SurfaceMesh& mesh, double feature_angle);

/// For each node of the source, the target node that is the same corner or end; -1: none, or not a feature.
///
/// Two features are the same if each is the other's nearest and they are no further apart than `tolerance` times the
/// longer of the mean faces around the two.
[[nodiscard]] std::vector<std::int32_t> match_features(const SurfaceMesh& source, const PolylineNodes& source_nodes,
                                                       const SurfaceMesh& target, const PolylineNodes& target_nodes,
                                                       double tolerance);

/// Faces one after the other, each beginning where the one before ends.
struct Chain {
  std::vector<std::int32_t> faces;
  std::vector<std::int32_t> nodes; ///< n_faces + 1; a loop's last is its first
  bool is_loop = false;            ///< without a cut: the last node goes on to the first
};

/// All faces of a polyline as chains: cut at branches, ends and the nodes given. In ascending order of first faces.
///
/// @param is_cut  n_nodes
[[nodiscard]] std::vector<Chain> chains_of(const SurfaceMesh& mesh, const PolylineNodes& nodes,
                                           const std::vector<bool>& is_cut);

} // namespace mullion::surface
