// Vectors that this processor has: a loop over groups is compiled for eight, four and the baseline's lanes, and the
// widest that runs here is taken when it is called.
#pragma once

#include "lanes.hpp"
#include "solver.hpp"

#include <algorithm>
#include <type_traits>

namespace mullion::euler {

template <int N> using Count = std::integral_constant<int, N>;

// Eight or four at a time where the processor can. The bits are the same: each operation is rounded by itself, no
// product is contracted with a sum (-ffp-contract=off), and no lane sees another.
#if defined(__x86_64__)
template <class Loop> [[gnu::target("avx512f,avx512dq,avx512vl"), gnu::noinline]] void run_widest(const Loop& loop)
{
  loop(Count<8>{});
}
template <class Loop> [[gnu::target("avx2"), gnu::noinline]] void run_wide(const Loop& loop) { loop(Count<4>{}); }
#endif

/// Runs a loop with vectors that this processor has. It gets the number of lanes, and must be inlined always.
template <class Loop> void run_with(Width width, const Loop& loop)
{
#if defined(__x86_64__)
  static const Width best = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                                    __builtin_cpu_supports("avx512vl") != 0
                                ? Width::eight
                            : __builtin_cpu_supports("avx2") != 0 ? Width::four
                                                                  : Width::baseline;
  const auto chosen = std::min(width, best);
  if (chosen == Width::eight) return run_widest(loop);
  if (chosen == Width::four) return run_wide(loop);
#else
  (void)width;
#endif
  loop(Count<4>{});
}

} // namespace mullion::euler
