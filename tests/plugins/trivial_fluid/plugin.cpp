#include "trivial_fluid.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::test::TrivialFluid, "fluid", "trivial_fluid", "test fluid: traction = 0.5 velocity + offset");
