// What a driver plug-in exports behind its mullion_header. C++ types cross here, hence the build id in the header.
#pragma once

#include <mullion/sdk/abi.h>

#include <cstdint>
#include <memory>

namespace mullion {

class Driver;

struct DriverPlugin {
  const mullion_parameter_spec* parameters;
  std::uint32_t n_parameters;
  Driver* (*create)(const mullion_value* values); ///< the caller owns the driver
};

} // namespace mullion
