// "State lives in windows", checked: keep what a step wrote, do the step again, compare byte for byte.
#pragma once

#include "run/session.hpp"

#include <cstddef>
#include <vector>

namespace mullion::run {

class Audit {
public:
  /// Copy the working levels of all windows that this step wrote.
  void keep(Session& session);

  /// Compare the working levels with the copy.
  /// @param how "the same instances (--replay)" or "fresh processes (--amnesia)"
  /// @throws Error Errc::internal naming the first window, field and entry that differs
  void compare(Session& session, const TimeStep& step, const char* how) const;

private:
  struct Kept {
    std::uint32_t window, field;
    std::vector<std::byte> bytes;
  };
  std::vector<Kept> kept_;
};

} // namespace mullion::run
