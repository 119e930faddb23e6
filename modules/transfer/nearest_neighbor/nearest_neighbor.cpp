// The baseline that users of other couplers know as nearest neighbour: each fluid node's load goes to the nearest
// structure node, its motion comes from there. First order for motion, and no order for traction.
#include "surface_transfer/projected_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::nearest_neighbor {

using NearestNeighbor = surface_transfer::ProjectedTransfer<surface::nearest_nodes>;

} // namespace mullion::nearest_neighbor

MULLION_PLUGIN(mullion::nearest_neighbor::NearestNeighbor, "transfer", "nearest_neighbor",
               "loads and motion to and from the nearest node");
