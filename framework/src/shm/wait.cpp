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

void spin_turn(unsigned turn)
{
  // With more processes than cores a spinner that never yields keeps the one it waits for off the core.
  if (turn % 4 == 3) {
    ::sched_yield();
    return;
  }
  for (int i = 0; i < 8; ++i) {
#if defined(__x86_64__)
    _mm_pause();
#endif
  }
}

} // namespace mullion::shm
