// Where a field of a run lives.
#pragma once

#include <cstdint>

namespace mullion::run {

/// Ids of the control object and of the window.
struct FieldAddress {
  std::uint32_t window, field;
};

} // namespace mullion::run
