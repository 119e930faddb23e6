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

/// Is a comparison true in any lane?
template <class Mask> MULLION_INLINE bool any(const Mask& mask)
{
  constexpr std::size_t n = sizeof(Mask) / sizeof(std::int64_t);
  if constexpr (n == 8)
    return any(__builtin_shufflevector(mask, mask, 0, 1, 2, 3) | __builtin_shufflevector(mask, mask, 4, 5, 6, 7));
  else if constexpr (n == 4)
    return any(__builtin_shufflevector(mask, mask, 0, 1) | __builtin_shufflevector(mask, mask, 2, 3));
  else return (mask[0] | mask[1]) != 0;
}

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
    const auto low = turned<4, Rows, 4>(std::array<Rows, 4>{rows[0], rows[1], rows[2], rows[3]});
    const auto high = turned<4, Rows, 4>(std::array<Rows, 4>{rows[4], rows[5], rows[6], rows[7]});
    for (int v = 0; v < n; ++v) lanes[v] = __builtin_shufflevector(low[v], high[v], 0, 1, 2, 3, 4, 5, 6, 7);
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
    std::array<Lanes<4>, 4> low, high;
    for (std::size_t v = 0; v < 4; ++v) {
      low[v] = __builtin_shufflevector(lanes[v], lanes[v], 0, 1, 2, 3);
      high[v] = __builtin_shufflevector(lanes[v], lanes[v], 4, 5, 6, 7);
    }
    low = turned<4, Lanes<4>, 4>(low);
    high = turned<4, Lanes<4>, 4>(high);
    return {low[0], low[1], low[2], low[3], high[0], high[1], high[2], high[3]};
  } else {
    std::array<Row<D>, N> rows{};
    for (std::size_t v = 0; v < n; ++v)
      for (std::size_t i = 0; i < N; ++i) rows[i][v] = lanes[v][i];
    return rows;
  }
}

} // namespace mullion::euler
