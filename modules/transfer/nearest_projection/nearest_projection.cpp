// The baseline that users of other couplers know as nearest projection, conservative for loads: the same kernel as
// node_projection, under its other name.
#include "surface_transfer/projected_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::nearest_projection {

using NearestProjection = surface_transfer::ProjectedTransfer<surface_transfer::closest_points>;

} // namespace mullion::nearest_projection

MULLION_PLUGIN(mullion::nearest_projection::NearestProjection, "transfer", "nearest_projection",
               "node_projection under the name that other couplers give it");
