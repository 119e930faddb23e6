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
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure) const override
  {
    const surface::FaceTree tree(structure, 0.0);
    return surface_transfer::pairing_by_nodes(fluid, structure, surface::node_projection(fluid, structure, tree));
  }

  Options options_;
};

} // namespace mullion::nearest_projection

MULLION_PLUGIN(mullion::nearest_projection::NearestProjection, "transfer", "nearest_projection",
               "node_projection under the name that other couplers give it");
