// Several numbers at a time: vectors of doubles as the compiler knows them, with its operators, and the few things that
// operators are not. A formula over a number type works with double and with these alike, and has the same bits in each
// lane: nothing here adds up across lanes.
#pragma once

#include "gas.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <type_traits>

// No vector is passed to a function that is not inlined, so no calling convention is at stake.
#pragma GCC diagnostic ignored "-Wpsabi"

namespace mullion::euler {

#define MULLION_INLINE [[gnu::always_inline]] inline // into versions for other instruction sets

template <std::size_t N> struct LanesOf {
  typedef double type __attribute__((vector_size(N * sizeof(double))));
};
template <std::size_t N> using Lanes = typename LanesOf<N>::type;

/// All variables of a cell, (rho, u, p) or the like: four in the plane; five in space, and three lanes of no meaning.
template <int D> using Row = Lanes<D == 2 ? 4 : 8>;

template <int D> MULLION_INLINE Row<D> row_of(const Values<D>& values)
{
  Row<D> row{};
  __builtin_memcpy(&row, values.data(), sizeof values);
  return row;
}
template <int D> MULLION_INLINE void put_row(const Row<D>& row, Values<D>& values)
{
  __builtin_memcpy(values.data(), &row, sizeof values);
}

template <class T> MULLION_INLINE T root(const T& x)
{
  if constexpr (std::is_same_v<T, double>) {
    return std::sqrt(x);
  } else {
    T result;
    for (std::size_t i = 0; i < sizeof(T) / sizeof(double); ++i) result[i] = std::sqrt(x[i]);
    return result;
  }
}

template <class T> MULLION_INLINE T size_of(const T& x) { return x < 0.0 ? -x : x; }

/// Is any lane not zero?
template <class Mask> MULLION_INLINE bool any(const Mask& mask)
{
  constexpr std::size_t n = sizeof(Mask) / sizeof(std::int64_t);
  if constexpr (n == 8)
    return any(__builtin_shufflevector(mask, mask, 0, 1, 2, 3) | __builtin_shufflevector(mask, mask, 4, 5, 6, 7));
  else if constexpr (n == 4)
    return any(__builtin_shufflevector(mask, mask, 0, 1) | __builtin_shufflevector(mask, mask, 2, 3));
  else return (mask[0] | mask[1]) != 0;
}

// Comparisons choose between two vectors and are never values themselves: the compiler would make those lane by lane.

/// Is x > 0 in all lanes? Not where it is no number.
template <class T> MULLION_INLINE bool all_positive(const T& x)
{
  using Mask = decltype(x > 0.0);
  return !any(x > 0.0 ? Mask{} : ~Mask{});
}

/// Is x > y in any lane, or no number?
template <class T> MULLION_INLINE bool any_above(const T& x, const T& y)
{
  using Mask = decltype(x <= y);
  return any(x <= y ? Mask{} : ~Mask{});
}

/// x where that is not positive or no number, y elsewhere: positive where both are.
template <class T> MULLION_INLINE T if_positive(const T& x, const T& y) { return x > 0.0 ? y : x; }

/// Rows of N faces or cells, turned: variable v of all of them in lanes v.
template <int n, class Rows, std::size_t N>
MULLION_INLINE std::array<Lanes<N>, n> turned(const std::array<Rows, N>& rows)
{
  std::array<Lanes<N>, n> lanes;
  if constexpr (n == 4 && N == 4) {
    const auto a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6);
    const auto b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7);
    const auto c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6);
    const auto d = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
    lanes = {__builtin_shufflevector(a, c, 0, 1, 4, 5), __builtin_shufflevector(b, d, 0, 1, 4, 5),
             __builtin_shufflevector(a, c, 2, 3, 6, 7), __builtin_shufflevector(b, d, 2, 3, 6, 7)};
  } else if constexpr (n == 4 && N == 8) {
    const auto both = [&rows](std::size_t i, std::size_t k) __attribute__((always_inline))
    {
      return __builtin_shufflevector(rows[i], rows[k], 0, 1, 2, 3, 4, 5, 6, 7);
    };
    const auto r02 = both(0, 2), r13 = both(1, 3), r46 = both(4, 6), r57 = both(5, 7);
    const auto a = __builtin_shufflevector(r02, r13, 0, 8, 2, 10, 4, 12, 6, 14);
    const auto b = __builtin_shufflevector(r02, r13, 1, 9, 3, 11, 5, 13, 7, 15);
    const auto c = __builtin_shufflevector(r46, r57, 0, 8, 2, 10, 4, 12, 6, 14);
    const auto d = __builtin_shufflevector(r46, r57, 1, 9, 3, 11, 5, 13, 7, 15);
    lanes = {__builtin_shufflevector(a, c, 0, 1, 4, 5, 8, 9, 12, 13),
             __builtin_shufflevector(b, d, 0, 1, 4, 5, 8, 9, 12, 13),
             __builtin_shufflevector(a, c, 2, 3, 6, 7, 10, 11, 14, 15),
             __builtin_shufflevector(b, d, 2, 3, 6, 7, 10, 11, 14, 15)};
  } else {
    for (int v = 0; v < n; ++v)
      for (std::size_t i = 0; i < N; ++i) lanes[v][i] = rows[i][v];
  }
  return lanes;
}

/// And back.
template <int D, std::size_t N, std::size_t n>
MULLION_INLINE std::array<Row<D>, N> turned_back(const std::array<Lanes<N>, n>& lanes)
{
  if constexpr (n == 4 && N == 4) {
    return turned<4, Lanes<4>, 4>(lanes);
  } else if constexpr (n == 4 && N == 8) {
    // Pairs of a row stand together: a and c hold the rows 0, 2, 4, 6, b and d the others.
    const auto a = __builtin_shufflevector(lanes[0], lanes[1], 0, 8, 2, 10, 4, 12, 6, 14);
    const auto b = __builtin_shufflevector(lanes[0], lanes[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const auto c = __builtin_shufflevector(lanes[2], lanes[3], 0, 8, 2, 10, 4, 12, 6, 14);
    const auto d = __builtin_shufflevector(lanes[2], lanes[3], 1, 9, 3, 11, 5, 13, 7, 15);
    const auto r02 = __builtin_shufflevector(a, c, 0, 1, 8, 9, 2, 3, 10, 11);
    const auto r46 = __builtin_shufflevector(a, c, 4, 5, 12, 13, 6, 7, 14, 15);
    const auto r13 = __builtin_shufflevector(b, d, 0, 1, 8, 9, 2, 3, 10, 11);
    const auto r57 = __builtin_shufflevector(b, d, 4, 5, 12, 13, 6, 7, 14, 15);
    const auto first = [](const Lanes<8>& both) __attribute__((always_inline))
    {
      return __builtin_shufflevector(both, both, 0, 1, 2, 3);
    };
    const auto second = [](const Lanes<8>& both) __attribute__((always_inline))
    {
      return __builtin_shufflevector(both, both, 4, 5, 6, 7);
    };
    return {first(r02), first(r13), second(r02), second(r13), first(r46), first(r57), second(r46), second(r57)};
  } else {
    std::array<Row<D>, N> rows{};
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t i = 0; i < N; ++i) rows[i][v] = lanes[v][i];
    return rows;
  }
}

} // namespace mullion::euler
