// One direction per node in which a surface is left: interpolated over the faces it is a continuous field, so what is
// projected along it neither overlaps nor leaves holes between faces that meet at an angle.
#pragma once

#include "surface_mesh.hpp"

#include <Eigen/Core>

namespace mullion::surface {

/// Normals at the nodes of a surface in 3D.
///
///     n_i ~ sum_c e_c x f_c / (|e_c|^2 |f_c|^2)          Max 1999: exact on a sphere
///
/// over the corners c of faces at node i, e_c and f_c the edges from the node. Where faces meet at an angle (one of
/// their normals is more than 26 degrees off) the sum of unit normals weighted by the corners' angles instead: it does
/// not depend on how the faces beside the edge are cut.
///
/// Nodes at the same place (within 1e-12 of the mesh's extent, up to a chance of 1e-4 to miss a pair that is not
/// exactly at the same place) have the same normal, unless theirs differ by more than 60 degrees: seams do not tear.
///
/// @param mesh  @pre dimension 3, complaint_about() has none; degenerate faces do not count
/// @return      (3 x n_nodes) unit vectors, zero where there is no direction: no faces, or faces against each other
[[nodiscard]] Eigen::Matrix3Xd nodal_normals(const SurfaceMesh& mesh);

} // namespace mullion::surface
