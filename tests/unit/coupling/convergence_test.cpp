// When an iteration counts as converged, and when as diverged.
#include <mullion/coupling/convergence.hpp>

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/window.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

using namespace mullion;

namespace {

const TimeStep third_step{3, 0.5, 0.75, 0.25, 0};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();

/// Two components on three entities.
struct Values {
  alignas(64) double entries[6] = {};
  [[nodiscard]] ConstArray array() const { return {entries, 2, 3}; }
};

/// All entries the same.
Values all(double value) { return {{value, value, value, value, value, value}}; }

/// The message of the comparison; "": it threw nothing.
std::string complaint(Convergence& convergence, int iteration, const Values& now, const Values& before)
{
  try {
    convergence.compare(0, iteration, now.array(), before.array());
  } catch (const Error& error) {
    CHECK(error.code() == Errc::numeric);
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("a field passes when its change is at most the relative part of its size")
{
  Convergence convergence({{"velocity", 1e-3, 0.0}});
  convergence.begin_step(third_step);

  convergence.compare(0, 0, all(1.0).array(), all(1.0 + 0.9e-3).array());
  CHECK(convergence.is_reached());
  convergence.compare(0, 1, all(1.0).array(), all(1.0 + 1.1e-3).array());
  CHECK_FALSE(convergence.is_reached());
}

TEST_CASE("a field at rest passes by its floor, and without one by being equal")
{
  Convergence with_floor({{"velocity", 1e-6, 1e-12}}), without({{"velocity", 1e-6, 0.0}});
  with_floor.begin_step(third_step);
  without.begin_step(third_step);

  with_floor.compare(0, 0, all(0.0).array(), all(0.0).array());
  without.compare(0, 0, all(0.0).array(), all(0.0).array());
  CHECK(with_floor.is_reached());
  CHECK(without.is_reached());

  with_floor.compare(0, 1, all(0.0).array(), all(1e-13).array()); // the norm: 2.4e-13
  without.compare(0, 1, all(0.0).array(), all(1e-13).array());
  CHECK(with_floor.is_reached());
  CHECK_FALSE(without.is_reached());
}

TEST_CASE("all fields must pass, each by its last comparison, and none counts before it was compared")
{
  Convergence convergence({{"velocity", 1e-6, 0.0}, {"traction", 1e-6, 0.0}});
  convergence.begin_step(third_step);
  CHECK_FALSE(convergence.is_reached());

  convergence.compare(0, 0, all(1.0).array(), all(1.0).array());
  CHECK_FALSE(convergence.is_reached());
  convergence.compare(1, 0, all(1.0).array(), all(2.0).array());
  CHECK_FALSE(convergence.is_reached());
  convergence.compare(1, 1, all(1.0).array(), all(1.0).array());
  CHECK(convergence.is_reached());

  convergence.begin_step(third_step);
  CHECK_FALSE(convergence.is_reached());
}

TEST_CASE("what is still moving is told with its allowance")
{
  Convergence convergence({{"velocity", 0.5, 0.25}, {"traction", 1e-6, 0.0}});
  convergence.begin_step(third_step);
  Values now, before;
  now.entries[0] = 3.0;
  before.entries[0] = 1.0;

  convergence.compare(0, 0, now.array(), before.array());

  CHECK(convergence.describe() == "velocity changed by 2.000e+00, 1.750e+00 allowed; traction changed by 0.000e+00, "
                                  "0.000e+00 allowed");
}

TEST_CASE("what is not finite never converges: it throws, naming the field and the entry")
{
  for (const double value : {not_a_number, inf, -inf})
    for (const int entry : {0, 3, 5}) { // the first, one in the middle, the last
      CAPTURE(value);
      CAPTURE(entry);
      // With a tolerance that infinity would pass: inf <= inf.
      Convergence convergence({{"traction", inf, inf}});
      convergence.begin_step(third_step);
      Values now = all(2.0), before = all(1.0);
      now.entries[entry] = value;

      const auto message = complaint(convergence, 0, now, before);

      CHECK_FALSE(convergence.is_reached());
      CHECK(message.find("the traction changed by") != std::string::npos);
      const auto place = "[" + std::to_string(entry % 2) + ", " + std::to_string(entry / 2) + "]";
      CHECK_MESSAGE(message.find(place) != std::string::npos, message);
    }
}

TEST_CASE("equal infinities are no agreement")
{
  Convergence convergence({{"traction", 1e-6, 1e-9}});
  convergence.begin_step(third_step);

  CHECK(complaint(convergence, 0, all(inf), all(inf)) != "");
  CHECK_FALSE(convergence.is_reached());
}

TEST_CASE("a change that grows a million times beyond the step's first has diverged, and the message names the entry")
{
  Convergence convergence({{"velocity", 1e-6, 1e-12}});
  convergence.begin_step(third_step);
  const Values zero = all(0.0);
  Values first = zero, large = zero;
  first.entries[1] = 1e-3;
  large.entries[0] = 1.0;
  large.entries[5] = 0.99e3; // beside the other one 990.0005: just below 1e6 times the first

  CHECK(complaint(convergence, 0, first, zero) == "");
  CHECK(complaint(convergence, 1, large, zero) == "");
  large.entries[5] = 1.01e3;
  const auto message = complaint(convergence, 2, large, zero);

  CHECK(message == "the iteration has diverged: in step 3 (t = 0.5 s), iteration 3, the velocity changed by 1.010e+03, "
                   "1.000e-03 in the "
                   "first; most at [1, 2] (component, entity), from 0 to 1010; a smaller relaxation, or acceleration = "
                   "\"iqn_ils\", may help");
}

TEST_CASE("growth counts against the first change of this step, not of an earlier one")
{
  Convergence convergence({{"velocity", 1e-6, 1e-12}});
  convergence.begin_step(third_step);
  CHECK(complaint(convergence, 0, all(1e-9), all(0.0)) == "");

  convergence.begin_step(third_step);

  CHECK(complaint(convergence, 0, all(1.0), all(0.0)) == "");
  CHECK(complaint(convergence, 1, all(1e5), all(0.0)) == "");
}

TEST_CASE("a first change that passes is no measure: growth counts from the first that does not")
{
  Convergence convergence({{"velocity", 0.0, 1e-6}});
  convergence.begin_step(third_step);

  CHECK(complaint(convergence, 0, all(1e-15), all(0.0)) == "");
  CHECK(complaint(convergence, 1, all(1.0), all(0.0)) == ""); // however large: the first guess met the rest before
  CHECK(complaint(convergence, 2, all(1e5), all(0.0)) == "");
  CHECK(complaint(convergence, 3, all(1e7), all(0.0)) != "");
}
