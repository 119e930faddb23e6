// Does what a driver connects fit together? Checked against the plug-ins' declarations alone: no window exists
// yet, so that `mullion check` needs no memory and runs nobody's solver.
#pragma once

#include "plugin/catalogue.hpp"

#include <mullion/app/case_file.hpp>
#include <mullion/coupling/wiring.hpp>

#include <string>
#include <vector>

namespace mullion::config {

/// Offers to inputs that are not declared are no connections. For what Driver::define left, before anything else.
void drop_declined_offers(Wiring& wiring, const Case& value, plugin::Catalogue& catalogue);

/// All mistakes, one sentence each: unknown ports, units, locations, components or natures that differ, inputs
/// connected never or twice, more levels than there are.
/// A vector field (as many components as its window has dimensions) against a fixed number is left to the start
/// of the run, when the dimension is known.
std::vector<std::string> check_wiring(const Case& value, const Wiring& wiring, plugin::Catalogue& catalogue);

} // namespace mullion::config
