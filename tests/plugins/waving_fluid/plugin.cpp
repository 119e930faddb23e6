#include "waving_fluid.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::test::WavingFluid, "fluid", "waving_fluid",
               "test fluid: a plane mesh of quadrilaterals and triangles that waves");
