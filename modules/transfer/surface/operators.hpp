// The matrices of a transfer: load operators, interpolation of motion and mass matrices, from pairs of integration
// points or from projected nodes. Sparse, by rows, and the same to the bit however often they are built.
#pragma once

#include "aabb_tree.hpp"
#include "integration_points.hpp"
#include "operator_sum.hpp"
#include "surface_mesh.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <cstdint>
#include <span>
#include <vector>

namespace mullion::surface {

/// A field on one side: (components x entities), one entity a column.
using Field = Eigen::MatrixXd;
using FieldView = Eigen::Ref<const Eigen::MatrixXd>;

/// Where the source's field lives: on nodes, linear between them, or on faces, constant in each.
enum class Location { nodes, faces };

/// A term of a matrix.
struct Entry {
  std::int32_t row, column;
  double value;
};

/// The matrix that is the sum of its terms, see OperatorSum.
[[nodiscard]] Operator assembled(std::int64_t n_rows, std::int64_t n_columns, std::span<const Entry> entries);

/// B, which makes the loads of a target's nodes from a traction: R = B t.
///
///     B_ji = sum_q w_q N_s^j(q) N_f^i(q)          Jaiman et al. 2011, Eqs. (4) and (6), by the choice of points
///
/// With a facial source N_f is one in its face. Columns sum to the integral of N_f over the source if each source face
/// is covered once, so that the force is kept.
///
/// @return  (target nodes x source nodes or faces) [m or m^2]
[[nodiscard]] Operator load_operator(const SurfaceMesh& source, const SurfaceMesh& target,
                                     std::span<const IntegrationPoint> points, Location source_location);

/// sum_q w_q N_s^j N_s^k: the target's mass matrix on the metric of the points. Rows of nodes without a point are zero.
[[nodiscard]] Operator target_mass(const SurfaceMesh& target, std::span<const IntegrationPoint> points);

/// sum_q w_q N_f^i N_f^k: the same of the source.
[[nodiscard]] Operator source_mass(const SurfaceMesh& source, std::span<const IntegrationPoint> points);

/// integral N_i N_k over the mesh itself, by a rule that is exact on lines, triangles and plane quadrilaterals (two
/// points a direction).
[[nodiscard]] Operator native_mass(const SurfaceMesh& mesh);

/// P by closest points: P_ij = N_s^j at the point of the target that is closest to source node i.
///
/// Motion: u_f = P u_s. Loads by node projection: R_s = P^T R_f (Jaiman et al. 2011, Eq. (3)).
///
/// @return  (source nodes x target nodes) [1]; rows sum to one
[[nodiscard]] Operator node_projection(const SurfaceMesh& source, const SurfaceMesh& target,
                                       const FaceTree& target_tree);

/// P_ij = 1 for the target node j that is nearest to source node i.
[[nodiscard]] Operator nearest_nodes(const SurfaceMesh& source, const SurfaceMesh& target);

/// The loads of a mesh's own nodes from the traction of its faces, each face's force split equally among its nodes.
///
/// @return  (nodes x faces) [m or m^2]
[[nodiscard]] Operator face_split(const SurfaceMesh& mesh);

/// B = P^T M: loads by node projection from a traction, with M the source's native mass (nodal) or face split (facial).
[[nodiscard]] Operator projected_load_operator(const SurfaceMesh& source, const Operator& projection,
                                               Location source_location);

/// out_j = sum_i A_ji in_i for each component.
///
/// @param field  (components x columns of the operator)
/// @return       (components x rows of the operator)
[[nodiscard]] Field apply(const Operator& a, const FieldView& field);

/// out_i = sum_j A_ji in_j for each component, e.g. R_s = P^T R_f.
[[nodiscard]] Field apply_transposed(const Operator& a, const FieldView& field);

} // namespace mullion::surface
