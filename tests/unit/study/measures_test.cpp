// Each kind of measure on signals whose answer is known by hand.
#include "study/measures.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion;
using namespace mullion::study;

namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;
constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A history of one quantity `q` at equal steps.
ColumnTable history(std::size_t n, double dt, const std::function<double(double)>& formula)
{
  ColumnTable table{{"step", "time", "q"}, {{}, {}, {}}};
  for (std::size_t i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) * dt;
    table.columns[0].push_back(static_cast<double>(i));
    table.columns[1].push_back(t);
    table.columns[2].push_back(formula(t));
  }
  return table;
}

/// 1, 2, 4, 3, -5 at 0, 1, 2, 3, 4 s.
ColumnTable five()
{
  return {{"step", "time", "q", "w"}, {{0, 1, 2, 3, 4}, {0, 1, 2, 3, 4}, {1, 2, 4, 3, -5}, {2, 2, 2, 4, 8}}};
}

Measure of(const std::string& kind)
{
  Measure measure;
  measure.name = "m";
  measure.kind = kind;
  measure.quantity = "q";
  return measure;
}

/// The only value of a measure that has one.
double value_of(const Measure& measure, const ColumnTable& table)
{
  const auto values = evaluate(measure, table, {});
  REQUIRE(values.size() == columns_of(measure).size());
  REQUIRE(values[0]);
  return *values[0];
}

std::string refusal_of(const Measure& measure, const ColumnTable& table)
{
  try {
    (void)evaluate(measure, table, {});
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("amplitude, maximum, last, mean and sum of five numbers")
{
  CHECK(value_of(of("amplitude"), five()) == 4.5);
  CHECK(value_of(of("maximum"), five()) == 5.0);
  CHECK(value_of(of("last"), five()) == -5.0);
  CHECK(value_of(of("mean"), five()) == 1.0);
  CHECK(value_of(of("sum"), five()) == 5.0);
}

TEST_CASE("from and to choose rows, both ends included, and scale multiplies")
{
  auto measure = of("sum");
  measure.from = 1.0;
  measure.to = 3.0;
  measure.scale = 10.0;

  CHECK(value_of(measure, five()) == 90.0);

  measure.from = 5.0;
  measure.to = 6.0;
  CHECK(refusal_of(measure, five()) == "there are no rows from 5 s to 6 s; the history goes from 0 s to 4 s");
}

TEST_CASE("a border in time is met although times carry rounding")
{
  const auto table = history(11, 0.1, [](double) { return 1.0; }); // 3 * 0.1 > 0.3
  auto measure = of("sum");
  measure.to = 0.3;

  CHECK(value_of(measure, table) == 4.0);
}

TEST_CASE("first_time is the first time at which the magnitude is larger, and empty without one")
{
  auto measure = of("first_time");
  measure.above = 2.0;
  CHECK(value_of(measure, five()) == 2.0); // 2 itself is not larger
  measure.above = 4.5;
  CHECK(value_of(measure, five()) == 4.0); // by -5
  measure.above = 5.0;
  CHECK(!evaluate(measure, five(), {})[0]);
}

TEST_CASE("growth_rate finds the rate of an exponential sine, and nothing where nothing oscillates")
{
  auto measure = of("growth_rate");
  measure.scale = 2.0;
  const auto table =
      history(2001, 1e-3, [](double t) { return std::exp(1.5 * t) * std::sin(two_pi * 20.0 * t) + 7.0; });

  const auto values = evaluate(measure, table, {});

  REQUIRE(values.size() == 3);
  REQUIRE(values[0]);
  CHECK(std::abs(*values[0] - 3.0) < 1e-6); // the model is exact; the fit stops at changes of 1e-10 of sigma T = 3
  CHECK(*values[1] < 1e-6);
  CHECK(std::abs(*values[2] - 20.0) < 1e-6);
  CHECK(columns_of(measure) == std::vector<std::string>{"m", "m.residual", "m.frequency"});
  const auto flat = evaluate(measure, history(100, 0.1, [](double) { return 3.0; }), {});
  CHECK(!flat[0]);
  CHECK(!flat[1]);
}

TEST_CASE("dominant_frequency is that of a sine, and empty where nothing oscillates")
{
  const auto table = history(2001, 1e-3, [](double t) { return std::sin(two_pi * 20.0 * t); });

  CHECK(std::abs(value_of(of("dominant_frequency"), table) - 20.0) < 20.0 * 1e-6); // leakage at 40 periods
  CHECK(!evaluate(of("dominant_frequency"), history(100, 0.1, [](double) { return 3.0; }), {})[0]);
}

TEST_CASE("two_frequencies are those of two sines, the stronger first, with the other's height")
{
  const auto table = history(
      2001, 1e-3, [](double t) { return 0.25 * std::sin(two_pi * 11.5 * t) + std::sin(two_pi * 44.25 * t + 1.0); });
  const auto values = evaluate(of("two_frequencies"), table, {});

  CHECK(columns_of(of("two_frequencies")) == std::vector<std::string>{"m", "m.second", "m.second_height"});
  REQUIRE(values.size() == 3);
  CHECK(std::abs(*values[0] - 44.25) < 1e-4); // leakage at 88 and 65 periods: below 1/65^3 of a line
  CHECK(std::abs(*values[1] - 11.5) < 1e-3);
  CHECK(std::abs(*values[2] - 0.25) < 1e-3);
  CHECK(!evaluate(of("two_frequencies"), history(100, 1e-3, [](double) { return 1.0; }), {})[0]);
}

TEST_CASE("function is the run's answer to the call of that text")
{
  auto measure = of("function");
  measure.quantity = "structure.frequency(1)";
  measure.scale = 2.0;
  const RunFacts facts{0.0, 0, {{"structure.frequency(2)", 7.0}, {"structure.frequency(1)", 3.5}}};

  CHECK(*evaluate(measure, {}, facts)[0] == 7.0);
  measure.quantity = "structure.frequency(3)";
  CHECK_THROWS_WITH_AS((void)evaluate(measure, {}, facts),
                       "the run was not asked for 'structure.frequency(3)'; [output] functions of the case asks for "
                       "structure.frequency(2), structure.frequency(1)",
                       Error);
}

TEST_CASE("envelope_rate is exact for an exponential seen over whole periods, growing or decaying")
{
  for (const double sigma : {0.75, -0.75}) {
    // each window of 0.5 s holds 5 periods and is the one before times exp(0.5 sigma)
    const auto table = history(1001, 5e-3, [&](double t) { return std::exp(sigma * t) * std::sin(two_pi * 10.0 * t); });
    auto measure = of("envelope_rate");
    measure.window = 0.5;

    CHECK(std::abs(value_of(measure, table) - sigma) < 1e-11); // rounding of 100 sines of up to 300 radians
  }
}

TEST_CASE("envelope_rate needs two windows in which something varies")
{
  auto measure = of("envelope_rate");
  measure.window = 3.0;
  CHECK(refusal_of(measure, five()) == "the record of 4 s has 1 whole windows of 3 s; a slope needs two");
  measure.window = 1.0;
  CHECK(refusal_of(measure, five()) == "nothing varies in the window of 1 s from 0 s on"); // one sample a window
}

TEST_CASE("error_doubling takes the first centre at which the deviation is more than twice the first one")
{
  // +-1 until 10 s, +-5 from then on; a window of 1 s has 11 samples. With k of the large ones in it the mean square
  // is (11 - k + 25 k) / 11 > 4 from k = 2 on: the window that ends at 10.1 s, centre 9.6 s.
  int i = 0;
  const auto table = history(201, 0.1, [&](double t) { return (t < 9.95 ? 1.0 : 5.0) * (i++ % 2 == 0 ? 1.0 : -1.0); });
  auto measure = of("error_doubling");
  measure.window = 1.0;
  measure.offset = 0.0;
  measure.scale = 3.0;

  const auto values = evaluate(measure, table, {});

  REQUIRE(values.size() == 2);
  REQUIRE(values[0]);
  CHECK(std::abs(*values[0] - 3.0 * std::numbers::ln2 / 9.6) < 16 * epsilon); // times of up to 10 s by steps of 0.1 s
  CHECK(!values[1]);
}

TEST_CASE("error_doubling without a doubling has no rate but a bound, from the last centre")
{
  const auto table = history(201, 0.1, [](double t) { return 5.0 + std::sin(two_pi * t); });
  auto measure = of("error_doubling");
  measure.window = 2.0;

  const auto values = evaluate(measure, table, {});

  CHECK(!values[0]);
  REQUIRE(values[1]);
  CHECK(std::abs(*values[1] - std::numbers::ln2 / 19.0) < 16 * epsilon);
  CHECK(columns_of(measure) == std::vector<std::string>{"m", "m.bound"});
}

TEST_CASE("error_doubling looks for deviations from each window's mean, or from the offset")
{
  // a sine whose mean moves by 10 after 10 s: no error about its own mean but where the window sees the jump
  const auto table = history(201, 0.1, [](double t) { return std::sin(two_pi * t) + (t < 9.95 ? 0.0 : 10.0); });
  auto measure = of("error_doubling");
  measure.window = 2.0;
  measure.from = 11.0; // behind the jump: about the mean nothing doubles

  CHECK(!evaluate(measure, table, {})[0]);

  measure.from = 0.0;
  measure.offset = 10.0; // the deviation is large before the jump and falls: no doubling either
  CHECK(!evaluate(measure, table, {})[0]);
  measure.offset = 0.0;
  CHECK(evaluate(measure, table, {})[0]);
}

TEST_CASE("error_doubling needs a window that fits and something that varies in the first one")
{
  auto measure = of("error_doubling");
  measure.window = 5.0;
  CHECK(refusal_of(measure, five()) == "the record of 4 s is shorter than the window of 5 s");
  measure.window = 1.0;
  CHECK(refusal_of(measure, history(20, 0.1, [](double) { return 2.0; })) ==
        "nothing varies in the first 1 s, so that nothing can double");
}

TEST_CASE("a small oscillation is seen to double although a large one follows")
{
  // 1e-9 growing e-fold a second for 30 s, to 1e4: a difference of plain sums would lose the begin
  const auto table = history(30001, 1e-3, [](double t) { return 1e-9 * std::exp(t) * std::sin(two_pi * 10.0 * t); });
  auto measure = of("error_doubling");
  measure.window = 1.0;

  // the centre at which exp(t - 0.5) = 2, up to a step of 1e-3 s and what a part of a period matters in 10
  CHECK(std::abs(value_of(measure, table) - std::numbers::ln2 / (0.5 + std::numbers::ln2)) < 0.01);
}

TEST_CASE("ratio is the deviation at the end by that at the begin")
{
  int i = 0;
  const auto table = history(100, 1.0, [&](double t) { return (t < 50.0 ? 1.0 : 3.0) * (i++ % 2 == 0 ? 1.0 : -1.0); });
  auto measure = of("ratio");
  measure.window = 9.0; // ten samples, half of each sign

  CHECK(std::abs(value_of(measure, table) - 3.0) < 8 * epsilon);
}

TEST_CASE("reference_error interpolates the history at the times of the reference")
{
  ColumnTable table{{"step", "time", "q"}, {{0, 1, 2}, {0, 1, 2}, {0, 10, 20}}};
  auto measure = of("reference_error");
  measure.reference_times = {-1.0, 0.5, 1.5, 9.0}; // the first and last lie outside of the run
  measure.reference_values = {100.0, 5.0, 16.0, 100.0};

  CHECK(value_of(measure, table) == 1.0); // 15 against 16
  measure.scale = 4.0;
  CHECK(value_of(measure, table) == 0.25); // divided
  measure.norm = "rms";
  CHECK(value_of(measure, table) == std::sqrt(0.5) / 4.0); // of 0 and 1
  measure.reference_times = {7.0};
  measure.reference_values = {0.0};
  CHECK(refusal_of(measure, table) == "no time of the reference lies between 0 s and 2 s; is time_scale right?");
}

TEST_CASE("drift is the largest change of a sum of columns, by the size of another where that is asked")
{
  auto measure = of("drift");
  measure.quantity = "";
  measure.terms = {{"q", 1.0}, {"w", 0.5}};
  // 2, 3, 5, 5, -1: from 2 at most 3
  CHECK(value_of(measure, five()) == 3.0);
  measure.relative_to = "w";
  CHECK(value_of(measure, five()) == 3.0 / 8.0);
}

TEST_CASE("iterations are counted from the first step on")
{
  auto measure = of("iterations");

  const auto values = evaluate(measure, five(), {});

  CHECK(values[0] == 1.0); // (2 + 4 + 3 - 5) / 4
  CHECK(values[1] == 4.0);
  CHECK(columns_of(measure) == std::vector<std::string>{"m", "m.max"});
}

TEST_CASE("wall_time and steps are those of the run, without a history")
{
  CHECK(evaluate(of("wall_time"), {}, {2.5, 100})[0] == 2.5);
  CHECK(evaluate(of("steps"), {}, {2.5, 100})[0] == 100.0);
}

TEST_CASE("a measure of a column that is missing or not finite is refused with the place")
{
  auto measure = of("amplitude");
  measure.quantity = "qq";
  CHECK(refusal_of(measure, history(3, 1.0, [](double) { return 0.0; })) ==
        "there is no column 'qq'; known are step, time, q");
  CHECK(refusal_of(of("amplitude"), history(3, 1.0, [](double t) { return t < 1.5 ? 0.0 : std::nan(""); })) ==
        "'q' is nan at 2 s");
}
