// Where the wall time went: per module and call, split into the module's own work and the waiting around it.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

namespace mullion::run {

using Clock = std::chrono::steady_clock;

/// A number that one thread counts up while others look at it (`mullion inspect`): plain loads and stores.
class Counter {
public:
  Counter() = default;
  Counter(const Counter& other) : value_(other) {}
  Counter& operator=(const Counter& other)
  {
    value_.store(other, std::memory_order_relaxed);
    return *this;
  }
  operator std::int64_t() const { return value_.load(std::memory_order_relaxed); } // NOLINT: it is a number
  Counter& operator+=(std::int64_t n)
  {
    value_.store(*this + n, std::memory_order_relaxed);
    return *this;
  }

private:
  std::atomic<std::int64_t> value_{0};
};

struct CallTiming {
  std::string call;
  Counter count{};
  Counter wall_ns{}; ///< from the request to the answer, as the driver sees it
  Counter work_ns{}; ///< inside the module, arming and checks included
};

/// The call that rebuilds what is derived; it belongs to the start-up, not to the steps.
inline constexpr const char* attach_call = "attach";

inline std::int64_t nanoseconds_since(Clock::time_point begin)
{
  return std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
}

} // namespace mullion::run
