#include "stretch_1d.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::stretch_1d::Stretch1d, "mesh_motion", "stretch_1d", "1D mesh that stretches with its wall");
