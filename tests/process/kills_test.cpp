// Processes of a run that are killed or stopped from outside, at random moments: the run ends with a message that
// names who it was, all others end within a second, and what was written is what an undisturbed run writes.
#include "support/faulty_piston.hpp"
#include "support/replaced_hosts.hpp"

#include <doctest/doctest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;

namespace {

using Clock = std::chrono::steady_clock;

/// What was written before the end is a part of what the undisturbed run wrote.
void check_part(const test::RunFolder& folder)
{
  if (!std::filesystem::exists(folder / "out/history.csv")) return; // it ended before the first step
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
}

/// Kill the host of a module after a random time of its life.
void kill_host(const test::RunFolder& folder, int module, unsigned seed)
{
  const std::string instance = test::instances[module];
  std::mt19937 random(seed);
  const auto delay = std::chrono::microseconds(std::uniform_int_distribution(0, 400'000)(random));
  CAPTURE(instance);
  CAPTURE(seed);
  CAPTURE(delay.count());
  std::filesystem::remove_all(folder / "out");
  const auto run = folder.start(test::long_piston({"run.end_time=1000"})); // it never gets there
  const auto host = test::find_host(folder, module);
  REQUIRE(host != 0);
  std::this_thread::sleep_for(delay);

  ::kill(host, SIGKILL);
  const auto killed = Clock::now();
  const auto result = run->wait();

  CHECK(Clock::now() - killed < 2s); // detected at its next call, then a second
  test::check_failed(folder, result, 1,
                     {"module '" + instance + "' (", "process " + std::to_string(host) + ")",
                      "was killed by signal 9 (SIGKILL), in "});
  check_part(folder);
}

void kill_hosts(int times)
{
  const unsigned first_seed = std::random_device{}();
  MESSAGE("seeds from ", first_seed);
  const test::RunFolder folder;
  test::run_whole(folder);
  for (int module = 0; module < 4; ++module)
    for (int i = 0; i < times; ++i) kill_host(folder, module, first_seed + static_cast<unsigned>(25 * module + i));
}

void kill_orchestrators(int times)
{
  const unsigned first_seed = std::random_device{}();
  MESSAGE("seeds from ", first_seed);
  const test::RunFolder folder;
  test::run_whole(folder);
  for (int i = 0; i < times; ++i) {
    const unsigned seed = first_seed + static_cast<unsigned>(i);
    CAPTURE(seed);
    std::filesystem::remove_all(folder / "out");
    const auto run = folder.start(test::long_piston({"run.end_time=1000"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 1));
    std::mt19937 random(seed);
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 400'000)(random)));

    ::kill(test::find_orchestrator(folder, run->pid()), SIGKILL);
    const bool is_deserted = folder.is_deserted_within(1s);
    const auto result = run->wait();

    CHECK(is_deserted);
    test::check_failed(folder, result, 1,
                       {"run 'faulty': the orchestrator (process ", "was killed by signal 9 (SIGKILL), "});
    CHECK(test::read_record(folder / "out").at("outcome") == "died");
    check_part(folder);
  }
}

void kill_guards(int times)
{
  const test::RunFolder folder;
  test::run_whole(folder);
  for (int i = 0; i < times; ++i) {
    std::filesystem::remove_all(folder / "out");
    const auto run = folder.start(test::long_piston({"run.end_time=1000"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 10));
    CHECK(folder.processes().size() == 6);

    run->send(SIGKILL);

    test::check_nothing_left(folder);
    CHECK(run->wait().signal == SIGKILL);
    check_part(folder);
  }
}

} // namespace

TEST_CASE("a host that is killed at a random moment ends the run, with its name") { kill_hosts(3); }

TEST_CASE("an orchestrator that is killed is reported by the guard") { kill_orchestrators(3); }

TEST_CASE("when the guard is killed, everything goes") { kill_guards(3); }

TEST_SUITE("full")
{
  TEST_CASE("a host that is killed at a random moment ends the run, 25 times each") { kill_hosts(25); }
  TEST_CASE("an orchestrator that is killed is reported by the guard, 25 times") { kill_orchestrators(25); }
  TEST_CASE("when the guard is killed, everything goes, 25 times") { kill_guards(25); }
}

TEST_CASE("with on_failure = respawn a killed host is replaced, and the bytes are those of an undisturbed run")
{
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937 random(seed);
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston({"run.on_failure=respawn"}));

  test::replace_each_host(folder, [&](pid_t host) {
    std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 5'000)(random)));
    ::kill(host, SIGKILL);
  });
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  for (const char* instance : test::instances) CHECK(has(result.err, std::string("respawned '") + instance + "'"));
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
  test::check_nothing_left(folder);
}

TEST_CASE("a host that was stopped is ended at its deadline")
{
  for (int module = 0; module < 4; ++module) {
    CAPTURE(module);
    const test::RunFolder folder;
    const auto run = folder.start(test::long_piston({"run.end_time=1000", "run.call_deadline=0.5"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 10));

    ::kill(test::find_host(folder, module), SIGSTOP);
    const auto stopped = Clock::now();
    const auto result = run->wait();

    CHECK(Clock::now() - stopped >= 500ms);
    CHECK(Clock::now() - stopped < 2s);
    test::check_failed(
        folder, result, 1,
        {std::string("module '") + test::instances[module] + "' (",
         "did not answer within its deadline of 0.5 s (stopped, or in an endless loop?) and was killed"});
  }
}

TEST_CASE("a name is free again after its run was killed, whoever died")
{
  const test::RunFolder folder;
  for (const bool is_guard : {true, false}) {
    const auto run = folder.start(test::long_piston({"run.end_time=1000"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 1));
    ::kill(is_guard ? run->pid() : test::find_orchestrator(folder, run->pid()), SIGKILL);
    REQUIRE(folder.is_deserted_within(1s));

    CHECK(folder.command({"ps"}).out == "no live runs\n");
    CHECK(folder.run(test::piston()).exit_code == 0);
  }
}
