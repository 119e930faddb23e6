#include "probe_structure.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::probe_structure::ProbeStructure, "structure", "probe_structure",
               "given motion of a given surface, and a check of the load that comes back");
