#include "point_transfer.hpp"

#include <mullion/sdk/plugin.hpp>

MULLION_PLUGIN(mullion::point_transfer::PointTransfer, "transfer", "point_transfer",
               "transfer between interfaces of the same points (1D problems)");
