// Damage for the readers' tests, the same for the same seed: flipped bits, overwritten runs, cuts, insertions, blocks
// copied elsewhere, and numbers that are easily forgotten. Number i of a test depends on the seed and on i alone, so
// that one of them can be made again without those before it. MULLION_MUTATION_SEED and MULLION_MUTATION_COUNT
// overrule seed and number.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace mullion::testing {

inline std::uint64_t number_from(const char* variable, std::uint64_t otherwise)
{
  const char* const text = std::getenv(variable);
  return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
}

/// SplitMix64: one addition and a mix, and every seed is a good one.
class Random {
public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t next()
  {
    auto z = state_ += 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  /// From 0 to n - 1; 0 if there is nothing to choose from.
  std::size_t below(std::size_t n) { return n == 0 ? 0 : static_cast<std::size_t>(next() % n); }
  template <class List> const auto& one_of(const List& list) { return list[below(std::size(list))]; }

private:
  std::uint64_t state_;
};

/// What counts, sizes and offsets are wrong by: nothing, one, a sign, the largest, twice that.
inline constexpr std::uint64_t forgotten_numbers[] = {0,
                                                      1,
                                                      2,
                                                      4095,
                                                      4096,
                                                      0x7fffffff,
                                                      0x80000000,
                                                      0xffffffff,
                                                      std::uint64_t{1} << 40,
                                                      std::uint64_t{1} << 61,
                                                      0x7fffffffffffffff,
                                                      0x8000000000000000,
                                                      0xfffffffffffffff8,
                                                      0xffffffffffffffff,
                                                      0x7ff0000000000000,  // an infinite double
                                                      0x7ff8000000000000}; // none at all

/// One change between `first` and `last` (its size may change if `last` is its end).
template <class Bytes> void mutate_once(Bytes& bytes, std::size_t first, std::size_t last, Random& random)
{
  using Byte = typename Bytes::value_type;
  last = std::min(last, bytes.size());
  first = std::min(first, last);
  const bool may_resize = last == bytes.size();
  const auto at = first + random.below(last - first);
  const auto run = std::min(last - at, 1 + random.below(16));
  const auto put = [&](std::uint64_t value, std::size_t size) {
    const auto aligned = std::max(first, at / size * size);
    if (aligned + size <= last) std::memcpy(bytes.data() + aligned, &value, size); // little-endian: the low bytes
  };
  switch (random.below(8)) {
  case 0:
    if (at < last) bytes[at] = static_cast<Byte>(static_cast<unsigned>(bytes[at]) ^ (1u << random.below(8)));
    return;
  case 1:
    for (std::size_t i = 0; i < run; ++i) bytes[at + i] = static_cast<Byte>(random.next());
    return;
  case 2: return put(random.one_of(forgotten_numbers), 4);
  case 3: return put(random.one_of(forgotten_numbers), 8);
  case 4: { // a number close to what stands there
    std::uint64_t value = 0;
    const auto aligned = std::max(first, at / 4 * 4);
    if (aligned + 4 > last) return;
    std::memcpy(&value, bytes.data() + aligned, 4);
    return put(value + random.below(17) - 8, 4);
  }
  case 5: { // a block to another place
    const auto size = std::min(last - at, 1 + random.below(256));
    const auto to = first + random.below(last - first - size + 1);
    if (size > 0) std::memmove(bytes.data() + to, bytes.data() + at, size);
    return;
  }
  case 6:
    if (!may_resize) return put(random.one_of(forgotten_numbers), 8);
    bytes.resize(random.below(4) == 0 ? at : last - std::min(last - first, random.below(64)));
    return;
  default:
    if (!may_resize) return put(random.next(), 8);
    bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), 1 + random.below(64),
                 static_cast<Byte>(random.next()));
  }
}

/// One to eight of them.
template <class Bytes> void mutate(Bytes& bytes, std::size_t first, std::size_t last, Random& random)
{
  const bool is_whole = last >= bytes.size();
  for (auto n = 1 + random.below(8); n > 0; --n) mutate_once(bytes, first, is_whole ? bytes.size() : last, random);
}

/// Calls `act(random)` so many times, each with a generator of its own; says seed and number of the one that fails.
template <class Act> void for_each_mutation(std::uint64_t count, Act&& act)
{
  const auto seed = number_from("MULLION_MUTATION_SEED", 20), n = number_from("MULLION_MUTATION_COUNT", count);
  MESSAGE("MULLION_MUTATION_SEED=", seed, ", ", n, " mutations");
  for (std::uint64_t i = 0; i < n; ++i) {
    INFO("mutation ", i, " of seed ", seed);
    Random random(seed * 0x100000001u + i);
    random.next(); // neighbouring seeds part here
    act(random);
  }
}

} // namespace mullion::testing
