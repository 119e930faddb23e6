// The baseline that users of other couplers know as nearest projection, conservative for loads: the same kernel as
// node_projection, under its other name.
#include "surface_transfer/surface_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::nearest_projection {

using surface_transfer::Pairing;

class NearestProjection final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    static constexpr auto table() { return common_table(); }
  };
  explicit NearestProjection(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure,
                             const surface_transfer::Wanted& wanted) const override
  {
    const auto projection = surface::node_projection(fluid, structure, surface::FaceTree(structure, 0.0));
    return {surface::operators_of_projection(fluid, structure, projection, wanted.location, wanted.fluid_mass),
            surface_transfer::report_of_projection(fluid, structure, projection)};
  }

  Options options_;
};

} // namespace mullion::nearest_projection

MULLION_PLUGIN(mullion::nearest_projection::NearestProjection, "transfer", "nearest_projection",
               "node_projection under the name that other couplers give it");
