// Transfer by node projection (Farhat, Lesoinne, Le Tallec 1998; Jaiman et al. 2011, Eq. (3)): each fluid node's load
// goes to the structure's shape functions where the node lies. Keeps force and work with interpolated motion; a
// constant traction arrives wrong by tens of per cent where the meshes do not match.
#include "surface_transfer/projected_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::node_projection {

using NodeProjection = surface_transfer::ProjectedTransfer<surface_transfer::closest_points>;

} // namespace mullion::node_projection

MULLION_PLUGIN(mullion::node_projection::NodeProjection, "transfer", "node_projection",
               "loads of the fluid's nodes, projected on the structure");
