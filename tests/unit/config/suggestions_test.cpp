#include "config/suggestions.hpp"

#include <doctest/doctest.h>

using namespace mullion::config;

TEST_CASE("a misspelt name finds the one that was meant")
{
  const std::vector<std::string> known = {"end_time", "start_time", "dt", "name"};

  CHECK(nearest_name("end_tiem", known) == "end_time"); // two letters swapped
  CHECK(nearest_name("endtime", known) == "end_time");  // one left out
  CHECK(nearest_name("names", known) == "name");        // one too many
  CHECK(nearest_name("star_tyme", known) == "start_time");
}

TEST_CASE("a name is not near if more than a third of its letters differ")
{
  CHECK(nearest_name("abcdef", {"abcdxy"}) == "abcdxy"); // 2 of 6
  CHECK(nearest_name("abcdef", {"abcxyz"}) == "");       // 3 of 6
  CHECK(nearest_name("dx", {"dt"}) == "");               // 1 of 2
  CHECK(nearest_name("", {"dt"}) == "");
}

TEST_CASE("of two near names the nearer one wins, of equals the first")
{
  CHECK(nearest_name("traction", {"fraction", "tractions", "traction"}) == "traction");
  CHECK(nearest_name("bound_a", {"bound_b", "bound_c"}) == "bound_b");
}

TEST_CASE("a suggestion names the nearest, or what is known, at most twelve")
{
  const std::vector<std::string> thirteen = {"a1", "a2", "a3", "a4", "a5", "a6", "a7",
                                             "a8", "a9", "b1", "b2", "b3", "b4"};

  CHECK(suggestion("evrey", {"every", "history"}) == "; did you mean 'every'?");
  CHECK(suggestion("folder", {"every", "history"}) == "; known are every, history");
  CHECK(suggestion("zzz", thirteen) == "; known are a1, a2, a3, a4, a5, a6, a7, a8, a9, b1, b2, b3, …");
  CHECK(suggestion("zzz", {}) == "");
}
