// The operators of a common refinement straight from the overlay's pieces, and of a quadrature projection from its
// points, source face by source face: neither pieces nor points are kept, of which a large interface has tens of
// millions.
#pragma once

#include "integration_points.hpp"
#include "transfer_operators.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace mullion::surface {

/// Takes the pieces of an overlay in their order (ascending source faces), or the points of source faces one by one;
/// finish() makes the operators.
///
/// A source face without any piece hands its load to the closest points of the target, so that the force is kept; the
/// overlay's report tells of it.
///
/// Up to round-off the operators are those of operators_of_points() with points_of_overlay() and add_closest_points().
class OverlayAssembly {
public:
  OverlayAssembly(const SurfaceMesh& source, const SurfaceMesh& target, Location source_location, Metric metric,
                  MassMetric mass, SourceMass source_mass = SourceMass::factorised,
                  Offsets offsets = Offsets::left_out);

  void add(const Subelement& piece);
  /// All points of a source face that has no pieces. With native masses only: see operators_of_points().
  void add_points(std::int32_t face, std::span<const IntegrationPoint> points);
  [[nodiscard]] TransferOperators finish(const FaceTree& target_tree);

private:
  void integrate_face(); ///< all pieces of one source face
  void attach_uncovered(const FaceTree& target_tree);

  const SurfaceMesh& source_;
  const SurfaceMesh& target_;
  Location location_;
  Metric metric_;
  MassMetric mass_;
  bool has_source_mass_;
  std::vector<Subelement> pieces_;         ///< of the source face at hand
  std::vector<IntegrationPoint> points_;   ///< theirs
  std::vector<std::int32_t> target_nodes_; ///< that they touch
  std::vector<double> local_;              ///< their loads by source node and by target node
  OperatorSum nodal_, facial_, source_mass_;
  bool has_links_;
  RigidLinkSum nodal_link_, facial_link_;
  std::vector<std::pair<std::int32_t, Point>> arms_; ///< of the source face at hand: target face, arm of each node
  std::vector<bool> is_covered_;                     ///< the source faces
  /// On the metric of the points: of each target face its nodes by its nodes, those with b >= a.
  std::vector<double> target_mass_;
  std::vector<std::int64_t> target_mass_begin_;
};

} // namespace mullion::surface
