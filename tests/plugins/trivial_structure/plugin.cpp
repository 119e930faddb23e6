#include "trivial_structure.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::test::TrivialStructure, "structure", "trivial_structure",
               "test structure: velocity = 0.5 traction + offset");
