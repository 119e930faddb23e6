// All that one pair of surfaces needs at run time, built once from the reference configuration: loads from the source
// to the target, motion from the target to the source, and the masses that recovery and adjoint motion divide by.
// What the schemes differ in is done before (integration_points.hpp, operators.hpp); from here on they are alike.
#pragma once

#include "aabb_tree.hpp"
#include "integration_points.hpp"
#include "mass_matrix.hpp"
#include "operators.hpp"
#include "rigid_link.hpp"

namespace mullion::surface {

/// On which surface the mass matrices are taken.
enum class MassMetric {
  same,  ///< that of the load operator: a constant traction is recovered exactly, whatever the gap
  native ///< each mesh's own
};

/// How motion goes from the target to the source.
enum class Motion {
  interpolate, ///< u_f = P u_s: local, never oscillates; rigid translations exact
  adjoint      ///< M_f u_f = B^T u_s: the work of both sides is the same
};

/// Source: where tractions and loads come from and motion goes to. Target: the other way.
struct TransferOperators {
  Location source_location = Location::nodes;
  Operator load;              ///< B of the source's location
  Operator nodal_load;        ///< B of a nodal source: for the adjoint motion
  Operator projection;        ///< P, source nodes x target nodes
  RigidLink load_link;        ///< what offsets add to `load`; empty if they are left out
  RigidLink nodal_link;       ///< to `nodal_load`
  RigidLink motion_link;      ///< to `projection`
  MassMatrix source_mass;     ///< M_f; not solvable if it was not wanted
  MassMatrix target_mass;     ///< M_s
  bool is_projection = false; ///< B = P^T M_f: loads of nodes go to loads by P^T alone, and `interpolate` is `adjoint`
};

/// Is M_f factorised? Adjoint motion and loads from nodal loads need it; it is a third of the memory.
enum class SourceMass { factorised, left_out };

/// What becomes of the distance between paired points.
enum class Offsets {
  left_out,  ///< motion and loads go from point to point
  rigid_link ///< as if over a rigid arm: rigid rotations and moments arrive whole
};

/// Node projection (P of node_projection()) and nearest neighbours (P of nearest_nodes()), with native masses.
[[nodiscard]] TransferOperators operators_of_projection(const SurfaceMesh& source, const SurfaceMesh& target,
                                                        Operator projection, Location source_location,
                                                        SourceMass source_mass = SourceMass::factorised);

/// Adds the links to operators of a projection.
void add_rigid_links(TransferOperators& operators, const SurfaceMesh& source, const SurfaceMesh& target,
                     const FaceTree& target_tree);

/// Common refinement and quadrature projection, from their points.
///
/// Quadrature projection should take native masses: on its own points they are singular where a face has too few.
[[nodiscard]] TransferOperators operators_of_points(const SurfaceMesh& source, const SurfaceMesh& target,
                                                    const FaceTree& target_tree, const PointSet& set,
                                                    Location source_location, MassMetric mass,
                                                    SourceMass source_mass = SourceMass::factorised);

/// Loads on the target [N] from the source's traction [Pa]: R_s = B t_f.
[[nodiscard]] Field loads_from_traction(const TransferOperators& operators, const FieldView& traction);

/// Loads on the target [N] from loads on the source's nodes or faces [N]; the sum is kept.
///
/// @pre  source_mass.is_solvable, for a nodal source unless is_projection
[[nodiscard]] Field loads_from_loads(const TransferOperators& operators, const SurfaceMesh& source,
                                     const FieldView& loads);

/// Motion of the source's nodes from that of the target's [m or m/s].
///
/// @pre  source_mass.is_solvable, for adjoint
[[nodiscard]] Field motion_of_source(const TransferOperators& operators, const FieldView& target_motion, Motion motion);

} // namespace mullion::surface
