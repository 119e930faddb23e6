#include "spring_mass.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::spring_mass::SpringMass, "structure", "spring_mass", "rigid mass on a linear spring");
