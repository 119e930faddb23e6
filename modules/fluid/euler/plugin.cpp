#include "euler.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::euler::Euler, "fluid", "euler",
               "2D compressible Euler equations, ALE finite volumes, any cells");
