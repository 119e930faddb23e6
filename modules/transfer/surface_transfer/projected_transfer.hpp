// Transfers that pair node by node: each fluid node has its place on the structure, loads go there by the projection
// transposed, motion comes from there by the projection. A plug-in chooses how a node finds its place.
#pragma once

#include "surface_transfer/surface_transfer.hpp"

#include <utility>

namespace mullion::surface_transfer {

/// @tparam project  P (fluid nodes x structure nodes) [1] of two meshes
template <surface::Operator (*project)(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure)>
class ProjectedTransfer final : public SurfaceTransfer {
public:
  struct Options : CommonOptions {
    static constexpr auto table() { return common_table(); }
  };
  explicit ProjectedTransfer(const Options& options) : SurfaceTransfer(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure,
                             const Wanted& wanted) const override
  {
    const auto projection = project(fluid, structure);
    auto operators = surface::operators_of_projection(fluid, structure, projection, wanted.location, wanted.fluid_mass);
    if (wanted.offsets == surface::Offsets::rigid_link)
      surface::add_rigid_links(operators, fluid, structure, surface::FaceTree(structure, 0.0));
    return {std::move(operators), report_of_projection(fluid, structure, projection)};
  }
};

/// The closest point of the structure's surface.
inline surface::Operator closest_points(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure)
{
  return surface::node_projection(fluid, structure, surface::FaceTree(structure, 0.0));
}

} // namespace mullion::surface_transfer
