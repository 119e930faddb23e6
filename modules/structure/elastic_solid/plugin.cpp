#include "elastic_solid.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::elastic_solid::ElasticSolid, "structure", "elastic_solid",
               "linear elastic solid in 2D and 3D, finite elements, implicit, explicit or static, with modal analysis");
