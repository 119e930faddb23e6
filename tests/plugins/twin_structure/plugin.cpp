// Another plug-in with the windows of faulty_structure: what a live run can be swapped to. It has its code, too, so
// that nothing but the name may change.
#include "../faulty_structure/faulty_structure.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::test::FaultyStructure, "structure", "twin_structure",
               "test structure: faulty_structure under another name");
