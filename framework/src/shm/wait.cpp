#include "shm/wait.hpp"

#include <climits>
#include <linux/futex.h>
#include <sched.h>
#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace mullion::shm {

static_assert(sizeof(Word) == sizeof(std::uint32_t));

void futex_sleep(const Word& word, std::uint32_t value)
{
  const timespec timeout{0, std::chrono::nanoseconds(longest_sleep).count()};
  ::syscall(SYS_futex, &word, FUTEX_WAIT, value, &timeout, nullptr, 0);
}

void futex_wake(const Word& word) { ::syscall(SYS_futex, &word, FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0); }

namespace {

constexpr std::chrono::microseconds long_yield{200};
constexpr int waits_without_spinning = 256;
thread_local int waits_to_skip = 0;

} // namespace

bool spinning_pays()
{
  if (waits_to_skip == 0) return true;
  --waits_to_skip;
  return false;
}

bool spin_turn(unsigned turn)
{
  // With more processes than cores a spinner that never yields keeps the one it waits for off the core.
  if (turn % 4 == 3) {
    const auto begin = std::chrono::steady_clock::now();
    ::sched_yield();
    if (std::chrono::steady_clock::now() - begin < long_yield) return true;
    waits_to_skip = waits_without_spinning;
    return false;
  }
  for (int i = 0; i < 8; ++i) {
#if defined(__x86_64__)
    _mm_pause();
#endif
  }
  return true;
}

} // namespace mullion::shm
