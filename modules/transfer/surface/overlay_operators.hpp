// The operators of a common refinement straight from the overlay's pieces, source face by source face: neither the
// pieces nor their integration points are kept, of which a large interface has tens of millions.
#pragma once

#include "integration_points.hpp"
#include "transfer_operators.hpp"

#include <array>
#include <vector>

namespace mullion::surface {

/// Takes the pieces of an overlay in their order (ascending source faces); finish() makes the operators.
///
/// Up to round-off those of operators_of_points() with points_of_overlay(), but for the facial mean, which is left out.
class OverlayAssembly {
public:
  OverlayAssembly(const SurfaceMesh& source, const SurfaceMesh& target, Location source_location, Metric metric,
                  MassMetric mass, SourceMass source_mass = SourceMass::factorised);

  void add(const Subelement& piece);
  [[nodiscard]] TransferOperators finish(const FaceTree& target_tree);

private:
  void integrate_face(); ///< all pieces of one source face

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
  std::vector<Entry> nodal_, facial_, source_mass_;
  std::vector<std::array<double, 16>> target_mass_; ///< of each target face, its nodes by its nodes
};

} // namespace mullion::surface
