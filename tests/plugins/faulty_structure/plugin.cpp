#include "faulty_structure.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::test::FaultyStructure, "structure", "faulty_structure",
               "test structure: a mass on a spring that misbehaves on request");
