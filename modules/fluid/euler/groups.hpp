// Groups of faces or cells that are taken at a time: which ones, what stands in arrays by their numbers, and how memory
// is asked for before it is needed. What is computed for a group is in lanes.hpp and the formulas.
#pragma once

#include "geometry.hpp"
#include "lanes.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace mullion::euler {

template <int N> using Numbers = std::array<std::size_t, static_cast<std::size_t>(N)>;

/// `first` and those behind it.
template <int N> MULLION_INLINE Numbers<N> numbers_from(std::size_t first)
{
  Numbers<N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = first + i;
  return numbers;
}

/// The same; the last one again where there are fewer.
template <int N> MULLION_INLINE Numbers<N> numbers_from(std::size_t first, std::size_t end)
{
  Numbers<N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = first + i < end ? first + i : end - 1;
  return numbers;
}

/// f(numbers) for one group after the other. The last one, where it is incomplete, has its last number several times.
template <int N, class Function> MULLION_INLINE void for_groups(std::size_t begin, std::size_t end, const Function& f)
{
  for (; begin + N <= end; begin += N) f(numbers_from<N>(begin));
  if (begin < end) f(numbers_from<N>(begin, end));
}

template <int N> MULLION_INLINE Lanes<N> lanes_at(const double* values, const Numbers<N>& numbers)
{
  Lanes<N> lanes;
  for (std::size_t i = 0; i < N; ++i) lanes[i] = values[numbers[i]];
  return lanes;
}

/// Asks for `count` things from things[first] on, which may lie beyond the array. A pass reads half a dozen arrays side
/// by side, more than the processor follows by itself.
template <int count, class T> MULLION_INLINE void fetch(const T* things, std::size_t first)
{
  const auto begin = reinterpret_cast<std::uintptr_t>(things) + first * sizeof(T);
  for (std::size_t at = 0; at < count * sizeof(T); at += 64)
    __builtin_prefetch(reinterpret_cast<const void*>(begin + at));
}

/// A face's plane as a row: n, A, s.
template <int D> MULLION_INLINE Row<D> plane_row(const FacePlane<D>& plane)
{
  static_assert(sizeof plane == sizeof(Values<D>));
  Row<D> row{};
  __builtin_memcpy(&row, &plane, sizeof plane);
  return row;
}

inline constexpr std::size_t faces_ahead = 128; ///< memory is asked for so early: some hundred nanoseconds
inline constexpr std::size_t cells_ahead = faces_ahead / 2;

} // namespace mullion::euler
