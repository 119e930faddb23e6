#include "string_1d.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::string_1d::String1d, "structure", "string_1d",
               "test structure: a generalised string, the wall of a channel, implicit Euler in time");
