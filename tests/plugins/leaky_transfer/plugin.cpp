// Node projection with a hole: of the load of the fluid's node 3 a tenth gets lost. No proper transfer does that, so
// this is what shows that a run says so.
#include "surface_transfer/projected_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {
namespace {

surface::Operator leaky_points(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure)
{
  auto projection = surface_transfer::closest_points(fluid, structure);
  for (Eigen::Index outer = 0; outer < projection.outerSize(); ++outer)
    for (surface::Operator::InnerIterator entry(projection, outer); entry; ++entry)
      if (entry.row() == 3) entry.valueRef() *= 0.9;
  return projection;
}

} // namespace

using LeakyTransfer = surface_transfer::ProjectedTransfer<leaky_points>;

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::LeakyTransfer, "transfer", "leaky_transfer",
               "test transfer: node projection that loses a tenth of one node's load");
