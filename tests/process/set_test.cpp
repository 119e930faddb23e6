// Parameters that change in a live run: `mullion set` does what a run with them does from there on, to the bit, and
// refuses what a live run cannot take.
#include "support/faulty_piston.hpp"
#include "support/steered_piston.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <csignal>
#include <string>
#include <utility>
#include <vector>

using namespace mullion;
using test::has;

TEST_CASE("set changes what is declared changeable from the next step on, and a run with other parameters differs")
{
  const test::RunFolder folder;
  auto every = test::piston({"run.name=every", "run.end_time=0.6094494002200441", "output.every=0"}, {"--inline"});
  every.out = "every";
  REQUIRE(folder.run(every).exit_code == 0);
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where}, {"output.history_every=1"});

    const auto same = folder.command({"set", test::piston_name, "structure.mass=520", "structure.stiffness=1.4e7"});
    const auto refused = folder.command({"set", test::piston_name, "structure.origin=2.0"});
    const auto two_tables = folder.command({"set", test::piston_name, "structure.mass=3", "driver.alpha=0.5"});
    const auto before = folder.steps_of(test::piston_name);
    const auto driver = folder.command({"set", test::piston_name, "driver.alpha=0.25"});
    run->send(SIGINT);
    const auto result = run->wait();

    CHECK_MESSAGE(same.exit_code == 0, same.err);
    CHECK(same.out == "structure: mass = 520, stiffness = 1.4e7\n");
    CHECK(refused.exit_code == 2);
    CHECK_MESSAGE(has(refused.err, "'structure' (faulty_structure) does not declare 'origin' as changeable: it may "
                                   "shape windows or first states, which a live run keeps; changeable are mass, "),
                  refused.err);
    CHECK(two_tables.exit_code == 2);
    CHECK_MESSAGE(driver.exit_code == 0, driver.err);
    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(test::events(folder) == std::vector<std::string>{"set structure", "set driver"});
    const auto event = test::read_record(folder / "out").at("attempts").at(0).at("events").at(1);
    const auto changed_at = event.at("step").get<long long>(); // the first step with it
    CHECK(changed_at > before);
    // Up to there the bytes are the whole run's, from there on they are not.
    const auto lines_until = [](const std::string& text, long long step) {
      std::size_t end = 0;
      for (long long line = 0; line <= step + 1; ++line) end = text.find('\n', end) + 1; // a header, and step 0
      return text.substr(0, end);
    };
    const auto here = test::read_file(folder / "out/history.csv");
    const auto whole = test::read_file(folder / "every/history.csv");
    CHECK(lines_until(here, changed_at - 1) == lines_until(whole, changed_at - 1));
    CHECK(lines_until(here, changed_at) != lines_until(whole, changed_at));
  }
}

TEST_CASE("parameters that are set at a step do the same inline and in processes, to the last bit")
{
  const test::RunFolder folder;
  auto clean = test::piston({"run.name=clean"}, {"--inline"});
  clean.out = "clean";
  REQUIRE(folder.run(clean).exit_code == 0);
  for (const char* where : {"--inline", "--processes"}) {
    auto run = test::piston({"structure.fault=slow", "structure.at_step=20", "structure.duration=1.0"}, {where});
    run.out = std::string(where).substr(2);
    const auto live = folder.start(run);
    REQUIRE(folder.wait_for_step(test::piston_name, 19)); // step 20 takes a second: the command waits for its end

    const auto mass = folder.start_command({"set", test::piston_name, "structure.mass=600"});

    CHECK(mass->wait().exit_code == 0);
    CHECK(live->wait().exit_code == 0);
  }
  CHECK(test::difference(folder / "inline", folder / "processes") == "");
  const auto here = test::read_file(folder / "inline/history.csv");
  const auto there = test::read_file(folder / "clean/history.csv");
  const auto same = std::mismatch(here.begin(), here.end(), there.begin(), there.end()).first - here.begin();
  CHECK(std::count(here.begin(), here.begin() + same, '\n') == 22); // the header, and steps 0 to 20
}

TEST_CASE("set refuses driver parameters that would connect other fields, and unknown ones with the near name")
{
  const test::RunFolder folder;
  const auto run = test::live_piston(folder, {"--processes"});

  for (const auto& [set, reason] : std::vector<std::pair<std::string, std::string>>{
           {"driver.motion=displacement", "driver css does not declare 'motion' as changeable"},
           {"driver.alhpa=0.5", "driver css has no parameter 'alhpa'; did you mean 'alpha'?"},
           {"driver.alpha=2", "alpha = 2 is out of range; expected a number in [0, 1]"},
           {"structre.mass=1", "the run has no module 'structre'; did you mean 'structure'?"},
           {"run.dt=1", "run.dt cannot be changed in a live run; of the run itself run.end_time and output.every can"},
           {"run.end_time=-1", "run.end_time = -1 s is not behind the run"},
           {"output.every=0", "output.every = 0: expected a number of steps >= 1"},
           {"mass=1", "'mass=1' names no table; write instance.parameter=VALUE"},
           {"structure.mass", "'structure.mass' has no '='"}}) {
    const auto result = folder.command({"set", test::piston_name, set});
    CHECK_MESSAGE(result.exit_code == 2, set);
    CHECK_MESSAGE(has(result.err, reason), result.err);
  }
  test::check_undisturbed(folder, *run);
}

TEST_CASE("driver parameters that let the first step fail are taken back, and the bytes are the same")
{
  const test::RunFolder folder;
  auto clean = test::long_piston({"driver.scheme=strong", "run.name=clean"}, {"--inline"});
  clean.out = "clean";
  REQUIRE(folder.run(clean).exit_code == 0);
  const auto run = folder.start(test::long_piston({"driver.scheme=strong"}, {"--processes"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

  const auto set = folder.command({"set", test::piston_name, "driver.max_iterations=1"});
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK(set.exit_code == 1);
  CHECK_MESSAGE(has(set.err, "set driver (max_iterations = 1) taken back, the one before it does step "), set.err);
  CHECK_MESSAGE(has(set.err, " has not converged after 1 iteration"), set.err);
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::difference_of_part(folder / "out", folder / "clean") == "");
}

TEST_CASE("run.end_time and output.every can be set: the results are those of a case that says so")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  // 20,000 steps and 7, the last of them shortened to half: css takes that.
  const std::string end = "run.end_time=0.12192949425502311";
  auto longer = test::long_piston({end}, {"--inline"});
  longer.out = "longer";
  longer.sets.emplace_back("run.name=longer");
  REQUIRE(folder.run(longer).exit_code == 0);
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

  const auto set = folder.command({"set", test::piston_name, end});
  const auto every = folder.command({"set", test::piston_name, "output.every=1000"}); // as it was
  const auto result = run->wait();

  CHECK_MESSAGE(set.exit_code == 0, set.err);
  CHECK_MESSAGE(every.exit_code == 0, every.err);
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::last_step(folder / "out") == test::last_step(folder / "longer"));
  CHECK(test::last_step(folder / "out") > 20000);
  CHECK(test::difference(folder / "out", folder / "longer") == "");
}
