// The baseline that users of other couplers know as nearest neighbour: each fluid node's load goes to the nearest
// structure node, its motion comes from there. First order for motion, and no order for traction.
#include "surface_transfer/surface_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::nearest_neighbor {

using surface_transfer::Pairing;

class NearestNeighbor final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    static constexpr auto table() { return common_table(); }
  };
  explicit NearestNeighbor(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure) const override
  {
    return surface_transfer::pairing_by_nodes(fluid, structure, surface::nearest_nodes(fluid, structure));
  }

  Options options_;
};

} // namespace mullion::nearest_neighbor

MULLION_PLUGIN(mullion::nearest_neighbor::NearestNeighbor, "transfer", "nearest_neighbor",
               "loads and motion to and from the nearest node");
