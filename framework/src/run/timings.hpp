// Where the wall time went: per module and call, split into the module's own work and the waiting around it.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace mullion::run {

using Clock = std::chrono::steady_clock;

struct CallTiming {
  std::string call;
  std::int64_t count = 0;
  std::int64_t wall_ns = 0; ///< from the request to the answer, as the driver sees it
  std::int64_t work_ns = 0; ///< inside the module, arming and checks included
};

/// The call that rebuilds what is derived; it belongs to the start-up, not to the steps.
inline constexpr const char* attach_call = "attach";

inline std::int64_t nanoseconds_since(Clock::time_point begin)
{
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
}

} // namespace mullion::run
