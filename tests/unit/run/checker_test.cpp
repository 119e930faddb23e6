// The check of large fields beside the run: every value is looked at, whoever does it, and outcomes come in the order
// in which the fields were added.
#include "run/checker.hpp"

#include <doctest/doctest.h>

#include <cstdint>
#include <limits>
#include <vector>

using mullion::run::Checker;

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::int64_t n = 300'001; // chunks are of 131072 values: two whole ones and a part

} // namespace

TEST_CASE("a value that is not finite is found in every chunk, and the first of several is told")
{
  Checker checker;
  std::vector<double> values(n, 1.0);

  checker.add(values.data(), n);
  CHECK(checker.outcome(0) == -1);
  checker.clear();
  for (const std::int64_t at :
       {n - 1, std::int64_t{262'144}, std::int64_t{262'143}, std::int64_t{70'000}, std::int64_t{0}}) {
    values[at] = nan; // those before stay: the first is what counts
    checker.add(values.data(), n);
    CHECK(checker.outcome(0) == at);
    checker.clear();
  }
}

TEST_CASE("several fields under way each get their own outcome, in whatever order these are asked for")
{
  std::vector<std::vector<double>> fields(5, std::vector<double>(n, 1.0));
  for (std::size_t f = 1; f < fields.size(); ++f) fields[f][1000 * f] = nan; // the first one is clean
  Checker checker;

  for (const auto& field : fields) checker.add(field.data(), n);

  for (const std::size_t f : {3, 0, 4, 1, 2}) {
    CAPTURE(f);
    CHECK(checker.outcome(f) == (f == 0 ? -1 : static_cast<std::int64_t>(1000 * f)));
  }
}

TEST_CASE("after clear the fields may be written again, and checked again")
{
  Checker checker;
  std::vector<double> values(n, 1.0);

  for (int k = 0; k < 200; ++k) { // often enough for the thread sanitizer to catch the thread at it
    checker.add(values.data(), n);
    checker.clear();
    for (auto& value : values) value += 1.0;
  }

  checker.add(values.data(), n);
  CHECK(checker.outcome(0) == -1);
  CHECK(values[0] == 201.0);
}
