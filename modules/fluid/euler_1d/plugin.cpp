#include "euler_1d.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::euler_1d::Euler1d, "fluid", "euler_1d", "1D compressible Euler equations, ALE finite volumes");
