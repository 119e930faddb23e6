// Pairs of places with a weight, which is all that the integrals of a transfer need: from the pieces of an overlay
// (common refinement), or from Gauss points of the source that are projected on the target (quadrature projection).
#pragma once

#include "aabb_tree.hpp"
#include "subelement.hpp"
#include "surface_mesh.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace mullion::surface {

/// One term of every integral: a place on either side and the measure that it stands for.
struct IntegrationPoint {
  std::int32_t source_face, target_face;
  double source_xi[2], target_xi[2];
  double weight; ///< [m] in 2D, [m^2] in 3D
};

/// On which surface the integrals are taken: dGamma of the points (1 - a) x_source + a x_target, with a = 0, 1, 1/2.
enum class Metric { source, target, average };

/// Points, and what share of each source face they stood for before they were scaled.
struct PointSet {
  std::vector<IntegrationPoint> points;
  std::vector<double> coverage;           ///< n_source_faces: measure of its pieces / its own; 0: no piece
  std::vector<std::int32_t> target_empty; ///< target faces without a point, ascending
};

/// Points of an overlay's pieces. Two a segment, exact for products of linear functions; polygons are cut into
/// triangles with three points each, exact for those, or six points where a quadrilateral takes part.
///
/// Metrics source and average: the points of each source face are scaled by its own measure / that of its pieces, so
/// that constants keep their integral over the source, whatever the projection did to the pieces. On the source's
/// metric a face that is covered in part is scaled by a linear function, if that is positive, so that each of its shape
/// functions keeps its integral too, and a nodal traction its force. A source face whose
/// pieces have no measure (coverage below 1e-12) gets no point; add_closest_points() is for these.
///
/// @param pieces  grouped by source face
[[nodiscard]] PointSet points_of_overlay(const SurfaceMesh& source, const SurfaceMesh& target,
                                         std::span<const Subelement> pieces, Metric metric);

/// Integrals of a face's shape functions over the face [m or m^2]; zeros beyond its nodes.
[[nodiscard]] Eigen::Vector4d shape_integrals(const SurfaceMesh& mesh, std::int32_t face);

/// The same as points_of_overlay() for the pieces of one source face: appends its points.
///
/// @return  its coverage; 0: no point was appended
double add_points_of_face(const SurfaceMesh& source, const SurfaceMesh& target, std::span<const Subelement> pieces,
                          Metric metric, std::vector<IntegrationPoint>& points);

/// Appends the points of a source face, n a direction, each with the closest point of the target.
///
/// @return  false: the face has no measure and gets no points
bool add_closest_points(const SurfaceMesh& source, const FaceTree& target_tree, std::int32_t face, int n,
                        std::vector<IntegrationPoint>& points);

/// Receives the points of one source face.
using PointSink = std::function<void(std::int32_t face, std::span<const IntegrationPoint> points)>;

struct QuadratureOptions {
  int n_points = 2;         ///< Gauss points a direction on each source face, 1 to 64
  bool is_adaptive = false; ///< more where needed: see below
  double tolerance = 0.0;   ///< of the adaptive order; 0: only the rule of one point a target face
};

/// Quadrature projection (Jaiman et al. 2011, Eq. (4)): Gauss points of the source faces, each with the closest point
/// of the target, weighed on the source.
///
/// Adaptive (Cebral & Lohner 1997): the order is doubled, up to 64, on the source faces beside target faces that own no
/// point; target faces that stay empty at 64 lie beyond the source. With a tolerance, the order of all source faces is
/// doubled further until the load of a constant traction changes by less than the tolerance times its largest nodal
/// value. The kinks of the target's shape functions within a source face make this slow: the error falls with 1/n^2.
///
/// @pre  1 <= n_points <= 64
///
/// @param sink  gets the points of each source face that has a measure, ascending; they are gone after the call
void for_each_quadrature_face(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                              const QuadratureOptions& options, const PointSink& sink);

/// The same, all points at once: for a small mesh.
[[nodiscard]] PointSet quadrature_points(const SurfaceMesh& source, const SurfaceMesh& target,
                                         const FaceTree& target_tree, const QuadratureOptions& options);

} // namespace mullion::surface
