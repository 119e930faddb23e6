#include "elastic_bar.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::elastic_bar::ElasticBar, "structure", "elastic_bar",
               "1D elastic bar, linear finite elements, Newmark or central differences in time");
