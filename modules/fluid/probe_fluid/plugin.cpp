#include "probe_fluid.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::probe_fluid::ProbeFluid, "fluid", "probe_fluid",
               "given tractions on a given surface, and a check of the motion that comes back");
