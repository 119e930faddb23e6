// Offsets between surfaces that do not lie in one another, as rigid arms: a point of the source that stands off from
// its place on the target turns about it with the target's surface, and its load reaches the target with its moment.
#pragma once

#include "integration_points.hpp"
#include "operator_sum.hpp"
#include "operators.hpp"
#include "surface_mesh.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace mullion::surface {

/// What the arms add to a load operator B, or to an interpolation P, and its transposed.
///
///     u(q) = sum_j N_s^j(q) u_j + theta_e x r(q),    r = x_f - x_s,
///     theta_e = sum_k (n (b_k . u_k) / 2 - b_k (n . u_k)),    b_k = n x grad N_k    on the target face e of point q
///
/// theta_e is the rotation of the face for small displacements u of its nodes k: that of its normal, and half the curl
/// in its plane; exact for a rigid rotation. Linear, so that what is carried back is its transposed: a load t at q adds
/// the moment r x t to the face, as forces of its nodes without a resultant. Force and moment both arrive whole.
class RigidLink {
public:
  RigidLink() = default;

  /// @param arms  by component: (target faces x source entities), sum_q w_q N_f^i(q) r(q), or r itself for a node
  RigidLink(const SurfaceMesh& target, Operator arm_x, Operator arm_y, Operator arm_z);

  [[nodiscard]] bool is_empty() const { return rotations_.empty(); }

  /// loads += transposed link . traction; (components x target nodes), (components x source entities)
  void add_loads(const FieldView& traction, Field& loads) const;
  /// motion += link . target_motion; (components x source entities), (components x target nodes)
  void add_motion(const FieldView& target_motion, Field& motion) const;

private:
  /// How a target face turns with its nodes, in the reference configuration.
  struct Rotation {
    std::int32_t nodes[4] = {-1, -1, -1, -1};
    Point normal, b[4];
  };
  std::vector<Rotation> rotations_; ///< of each target face
  Operator arm_[3];
};

/// Sums up arms point by point.
class RigidLinkSum {
public:
  RigidLinkSum(std::int64_t n_target_faces, std::int64_t n_source_entities);

  void add(std::int32_t target_face, std::int32_t source_entity, const Point& arm);
  [[nodiscard]] RigidLink finish(const SurfaceMesh& target);

private:
  OperatorSum x_, y_, z_;
};

/// The arms of the source's nodes from where P puts them on the target, with the closest face there.
///
/// @param projection  P (source nodes x target nodes), rows sum to one
[[nodiscard]] RigidLink link_of_nodes(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                                      const Operator& projection);

/// The same for loads that go through the nodes: of a traction with these forces.
///
/// @param forces  (source nodes x source nodes or faces) [m or m^2], native_mass() or face_split()
[[nodiscard]] RigidLink link_of_forces(const SurfaceMesh& source, const SurfaceMesh& target,
                                       const FaceTree& target_tree, const Operator& projection, const Operator& forces);

} // namespace mullion::surface
