// Waiting for a 32-bit word in shared memory to change: spin briefly, yielding, then sleep on the futex, never
// longer than 5 ms at a time, because a wake can be missed and a peer can die. The waker makes the system call only
// if the peer says that it sleeps.
#pragma once

#include "shm/control.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>

namespace mullion::shm {

inline constexpr std::chrono::microseconds spin_time{100};
inline constexpr std::chrono::milliseconds longest_sleep{5};

/// Sleep while `word` holds `value`, at most `longest_sleep`; returns early on any wake.
void futex_sleep(const Word& word, std::uint32_t value);

/// Wake all who sleep on the word, in every process.
void futex_wake(const Word& word);

/// Whether spinning pays at present. On a machine whose cores are busy with others a yield takes a time slice of
/// theirs, milliseconds, where a wake from the futex takes microseconds: after such a yield this thread's next waits
/// go to sleep at once.
bool spinning_pays();

/// One turn of spinning: some pauses, and every few turns a yield. Pass 0, 1, 2, …
/// @return false if the yield took so long that the cores are evidently wanted by others
bool spin_turn(unsigned turn);

/// Wait until is_done() or is_over(); is_over is asked between sleeps and now and then while spinning.
/// @param word      the word that the peer changes
/// @param asleep    set while this thread sleeps, for the waker
/// @param may_spin  false in parallel schemes, where the cores belong to the solvers
template <class Done, class Over>
bool wait_for(const Word& word, Word& asleep, bool may_spin, Done&& is_done, Over&& is_over)
{
  if (may_spin && spinning_pays()) {
    const auto end = std::chrono::steady_clock::now() + spin_time;
    for (unsigned turn = 0;; ++turn) {
      if (is_done()) return true;
      if (!spin_turn(turn)) break;
      if (turn % 16 == 15) {
        if (is_over()) return is_done();
        if (std::chrono::steady_clock::now() >= end) break;
      }
    }
  }
  for (;;) {
    const auto seen = word.load(std::memory_order_acquire);
    if (is_done()) return true;
    if (is_over()) return is_done();
    asleep.store(1, std::memory_order_seq_cst); // then look again, so that a wake in between is not lost
    if (!is_done() && word.load(std::memory_order_seq_cst) == seen) futex_sleep(word, seen);
    asleep.store(0, std::memory_order_relaxed);
  }
}

/// Publish a new value of a word and wake the peer if it sleeps.
inline void publish(Word& word, std::uint32_t value, const Word& peer_asleep)
{
  word.store(value, std::memory_order_seq_cst);
  if (peer_asleep.load(std::memory_order_seq_cst) != 0) futex_wake(word);
}

} // namespace mullion::shm
