#include "run/step_clock.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <vector>

using namespace mullion;
using run::StepClock, run::TimePlan;

namespace {

/// Ten steps of 0.1 s from t = 1 s on, the last one shortened to 0.05 s. (Sums of these are not exact in binary.)
Case ten_steps()
{
  Case c;
  c.scheme = "some";
  c.start_time = 1.0;
  c.dt = 0.1;
  c.end_time = 1.95;
  return c;
}

/// All steps from here on, as (begin, end, dt, index).
std::vector<std::vector<double>> rest(StepClock clock)
{
  std::vector<std::vector<double>> steps;
  for (; !clock.is_at_end(); clock.advance()) {
    const auto step = clock.next();
    steps.push_back({step.begin, step.end, step.dt, static_cast<double>(step.index)});
  }
  return steps;
}

void advance(StepClock& clock, int n)
{
  for (int i = 0; i < n; ++i) clock.advance();
}

} // namespace

TEST_CASE("a clock that nobody halves gives the steps of the plan")
{
  const TimePlan plan(ten_steps(), false);
  StepClock clock(plan);

  CHECK(clock.n_steps() == 10);
  for (int n = 1; n <= 10; ++n, clock.advance()) {
    REQUIRE(!clock.is_at_end());
    CHECK(clock.next().begin == plan.step(n).begin);
    CHECK(clock.next().end == plan.step(n).end);
    CHECK(clock.next().dt == plan.step(n).dt);
    CHECK(clock.next().index == n);
  }
  CHECK(clock.is_at_end());
  CHECK(clock.time() == 1.95);
}

TEST_CASE("a halved step is done in parts that meet, end where the whole one ends, and are counted")
{
  const TimePlan plan(ten_steps(), false);
  StepClock clock(plan);
  advance(clock, 3);

  CHECK(clock.halve(2));
  CHECK(clock.halve(2));
  CHECK(!clock.halve(2)); // twice is what was allowed

  double end = plan.time(3);
  for (int part = 0; part < 4; ++part) {
    const auto step = clock.next();
    CHECK(step.begin == end);
    CHECK(step.dt == 0.1 / 4);
    CHECK(step.index == 4 + part);
    CHECK(clock.is_on_grid() == (part == 0));
    CHECK(clock.grid() == 3);
    end = step.end;
    clock.advance();
  }
  CHECK(end == plan.time(4));
  CHECK(clock.is_on_grid());
  CHECK(clock.grid() == 4);
  CHECK(clock.step() == 7);
  CHECK(clock.n_steps() == 7 + 6);
}

TEST_CASE("what is halved in the midst of a halved step goes on from where it stands")
{
  StepClock clock(TimePlan(ten_steps(), false));
  CHECK(clock.halve(9));
  clock.advance(); // the first half

  CHECK(clock.halve(9));

  CHECK(clock.next().begin == 1.0 + 0.5 * (1.1 - 1.0));
  CHECK(clock.next().dt == 0.1 / 4);
  advance(clock, 2);
  CHECK(clock.is_on_grid());
  CHECK(clock.grid() == 1);
}

TEST_CASE("after enough good steps a halved step is doubled again, later the next time")
{
  auto c = ten_steps();
  c.end_time = 1001.0;
  StepClock clock{TimePlan(c, false)};
  std::vector<std::int64_t> patience;
  for (int failure = 0; failure < 3; ++failure) {
    const auto before = clock.step();
    CHECK(clock.halve(9));
    while (clock.next().dt < 0.1) clock.advance();
    patience.push_back(clock.step() - before);
    CHECK(clock.is_on_grid());
  }
  CHECK(patience == std::vector<std::int64_t>{16, 32, 64});
}

TEST_CASE("a clock goes on from what a checkpoint holds of it as if nothing had happened")
{
  auto c = ten_steps();
  StepClock clock{TimePlan(c, false)};
  for (int n = 0; !clock.is_at_end(); ++n) {
    if (n == 3 || n == 6) CHECK(clock.halve(9));
    CHECK(rest(StepClock(c, false, clock.state())) == rest(clock));
    clock.advance();
  }
  CHECK(StepClock(c, false, clock.state()).is_at_end());
}

TEST_CASE("a checkpoint goes on with another step or to another end from its own time")
{
  auto c = ten_steps();
  StepClock clock{TimePlan(c, false)};
  advance(clock, 10); // to the end, at 1.95 s: no whole number of steps
  auto longer = c, finer = c;
  longer.end_time = 2.15;
  finer.end_time = 2.0;
  finer.dt = 0.025;

  const auto more = rest(StepClock(longer, false, clock.state()));
  const auto fine = rest(StepClock(finer, false, clock.state()));

  REQUIRE(more.size() == 2);
  CHECK(more[0] == std::vector<double>{1.95, 1.95 + 0.1, 0.1, 11});
  CHECK(more[1][1] == 2.15);
  CHECK(fine.size() == 2);
  const StepClock again(finer, false, clock.state());
  CHECK(again.is_whole(1.975)); // of the new times …
  CHECK(!again.is_whole(1.9));  // … the old ones are none
}

TEST_CASE("a clock refuses an end that lies behind it, and a damaged state")
{
  const auto c = ten_steps();
  StepClock clock{TimePlan(c, false)};
  advance(clock, 5);
  auto early = c;
  early.end_time = 1.4;
  auto damaged = clock.state();
  damaged.n_parts = 3;

  CHECK_THROWS_WITH(StepClock(early, false, clock.state()),
                    "the checkpoint holds the state at t = 1.5 s, behind run.end_time = 1.4 s; expected a later end");
  CHECK_THROWS_WITH(StepClock(c, false, damaged),
                    "the checkpoint's clock is damaged: 5 steps, 5 whole ones, 3 parts of 2^0");
}
