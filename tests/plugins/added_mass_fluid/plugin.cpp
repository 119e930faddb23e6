#include "added_mass_fluid.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::added_mass_fluid::AddedMassFluid, "fluid", "added_mass_fluid",
               "test fluid: potential flow in a channel, reduced to the added mass of its wall");
