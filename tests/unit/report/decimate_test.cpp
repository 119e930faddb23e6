// Thinning a history out: what must survive, and how much is left.
#include "report/decimate.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

using namespace mullion;
using namespace mullion::report;

namespace {

std::vector<double> ramp(std::size_t n)
{
  std::vector<double> x(n);
  for (std::size_t i = 0; i < n; ++i) x[i] = static_cast<double>(i);
  return x;
}

bool has(const std::vector<std::size_t>& indices, std::size_t index)
{
  return std::find(indices.begin(), indices.end(), index) != indices.end();
}

} // namespace

TEST_CASE("a spike of one step among a million survives, up and down")
{
  const auto x = ramp(1'000'000);
  std::vector<double> y(x.size());
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = std::sin(0.01 * x[i]);
  y[123'456] = 7.0;
  y[765'432] = -7.0;

  const auto chosen = decimate(x, y, 100);

  CHECK(has(chosen, 123'456));
  CHECK(has(chosen, 765'432));
  CHECK(has(chosen, 0));
  CHECK(has(chosen, x.size() - 1));
  CHECK(chosen.size() <= 400); // first, smallest, largest, last of each of 100 intervals
  CHECK(std::is_sorted(chosen.begin(), chosen.end()));
}

TEST_CASE("each interval keeps its first, smallest, largest and last value")
{
  // two intervals, [0, 7.5) and [7.5, 15]
  const std::vector<double> y = {0, 3, 9, 1, -4, 2, 2, 5, /* */ 8, 6, 7, 7, 1, 2, 3, 4};

  const auto chosen = decimate(ramp(16), y, 2);

  CHECK(chosen == std::vector<std::size_t>{0, 2, 4, 7, /* */ 8, 12, 15});
}

TEST_CASE("a short history stays whole")
{
  const auto x = ramp(50);

  CHECK(decimate(x, x, 10).size() == 50);
  CHECK(decimate({}, {}, 10).empty());
}

TEST_CASE("values that are not finite interrupt the curve once an interval")
{
  auto y = ramp(100);
  for (std::size_t i = 40; i < 60; ++i) y[i] = std::numeric_limits<double>::quiet_NaN();
  y[45] = std::numeric_limits<double>::infinity();

  const auto chosen = decimate(ramp(100), y, 2); // [0, 49.5) and [49.5, 99]

  CHECK(chosen == std::vector<std::size_t>{0, 39, 40, /* */ 50, 60, 99});
}

TEST_CASE("equal times and times that go back lose no extreme")
{
  std::vector<double> x(100, 1.0), y = ramp(100);
  y[50] = 1e3;
  CHECK(has(decimate(x, y, 4), 50));

  x = ramp(100);
  for (std::size_t i = 60; i < 100; ++i) x[i] -= 30.0; // a restart that wrote some steps again
  CHECK(has(decimate(x, y, 4), 50));
  CHECK_THROWS_AS((void)decimate(x, ramp(3), 4), Error);
}
