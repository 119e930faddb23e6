// Transfer by node projection (Farhat, Lesoinne, Le Tallec 1998; Jaiman et al. 2011, Eq. (3)): each fluid node's load
// goes to the structure's shape functions where the node lies. Keeps force and work with interpolated motion; a
// constant traction arrives wrong by tens of per cent where the meshes do not match.
#include "surface_transfer/surface_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::node_projection {

using surface_transfer::Pairing;

class NodeProjection final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    static constexpr auto table() { return common_table(); }
  };
  explicit NodeProjection(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure) const override
  {
    const surface::FaceTree tree(structure, 0.0);
    return surface_transfer::pairing_by_nodes(fluid, structure, surface::node_projection(fluid, structure, tree));
  }

  Options options_;
};

} // namespace mullion::node_projection

MULLION_PLUGIN(mullion::node_projection::NodeProjection, "transfer", "node_projection",
               "loads of the fluid's nodes, projected on the structure");
