// Vectors of several numbers: rows turned into variables and back, and questions about all lanes.
#include "euler/lanes.hpp"

#include <doctest/doctest.h>

#include <limits>

using namespace mullion::euler;

namespace {

/// Row i holds 10 i, 10 i + 1, …
template <int D, std::size_t N> std::array<Row<D>, N> numbered_rows()
{
  std::array<Row<D>, N> rows{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t v = 0; v < n_values<D>; ++v) rows[i][v] = 10.0 * static_cast<double>(i) + static_cast<double>(v);
  return rows;
}

template <int D, std::size_t N> void check_turning()
{
  const auto rows = numbered_rows<D, N>();

  const auto lanes = turned<n_values<D>, Row<D>, N>(rows);
  const auto back = turned_back<D, N>(lanes);

  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t v = 0; v < n_values<D>; ++v) {
      CHECK(lanes[v][i] == 10.0 * static_cast<double>(i) + static_cast<double>(v));
      CHECK(back[i][v] == rows[i][v]);
    }
}

} // namespace

TEST_CASE("euler: rows are turned into a vector for each variable, and back")
{
  check_turning<2, 4>();
  check_turning<2, 8>();
  check_turning<3, 4>();
  check_turning<3, 8>();
}

TEST_CASE("euler: one lane that is zero, negative or no number shows, whichever it is")
{
  const Lanes<8> ones = Lanes<8>{} + 1.0, twos = ones + ones;
  CHECK(all_positive(ones));
  CHECK_FALSE(any_above(ones, ones));
  CHECK_FALSE(any_above(ones, twos));
  for (std::size_t i = 0; i < 8; ++i)
    for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
      auto x = ones, y = ones;
      x[i] = bad;
      y[i] = bad > -1.0 ? 2.0 : std::numeric_limits<double>::quiet_NaN();
      CHECK_FALSE(all_positive(x));
      CHECK_FALSE(all_positive(if_positive(x, ones)));
      CHECK_FALSE(all_positive(if_positive(ones, x)));
      CHECK(any_above(y, ones));
    }
}
