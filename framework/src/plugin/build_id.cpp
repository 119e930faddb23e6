// The build id of this libmullion, for comparison with a driver's.
#include <mullion/coupling/build_id.hpp>

namespace mullion::plugin {

const char* driver_build_id() { return MULLION_BUILD_ID; }

} // namespace mullion::plugin
