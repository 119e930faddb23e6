// What a user does to a live run: Ctrl-C, once and twice, SIGTERM, a closed terminal, Ctrl-Z, `mullion stop`.
#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <unistd.h>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;

namespace {

using Clock = std::chrono::steady_clock;

/// A run that ended early as it was asked to: its files are those of the first steps of the whole run.
void check_stopped(const test::RunFolder& folder, const test::ProcessResult& result, const std::string& reason)
{
  CAPTURE(result.err);
  CHECK(!result.has_timed_out);
  CHECK(result.exit_code == 0);
  CHECK(test::error_messages(result).empty());
  CHECK(has(result.out, "run faulty: stopped by " + reason + ", "));
  const auto record = test::read_record(folder / "out");
  CHECK(record.at("outcome") == "stopped");
  CHECK(record.at("attempts").at(0).at("steps") == test::last_step(folder / "out"));
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
  test::check_nothing_left(folder);
}

bool are_all(const std::vector<test::RunProcess>& processes, char state)
{
  return std::all_of(processes.begin(), processes.end(), [&](const auto& process) { return process.state == state; });
}

} // namespace

TEST_CASE("one signal ends the run at the next step, whichever it is")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  for (const auto& [signal, name] :
       std::vector<std::pair<int, std::string>>{{SIGINT, "SIGINT"}, {SIGTERM, "SIGTERM"}, {SIGHUP, "SIGHUP"}})
    for (const char* where : {"--processes", "--inline"}) {
      CAPTURE(name);
      CAPTURE(where);
      std::filesystem::remove_all(folder / "out");
      const auto run = folder.start(
          test::long_piston({"structure.fault=slow", "structure.at_step=20", "structure.duration=0.3"}, {where}));
      REQUIRE(folder.wait_for_step(test::piston_name, 19));

      run->send(signal);
      const auto sent = Clock::now();
      const auto result = run->wait();

      CHECK(Clock::now() - sent < 2s);
      check_stopped(folder, result, name);
      CHECK(test::last_step(folder / "out") == 20); // the step at hand, which is slow
      CHECK(has(result.err, name + ": the run ends after the step at hand; once more ends it at once"));
    }
}

TEST_CASE("a signal that arrives twice within a tenth of a second is one")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston({"structure.fault=slow", "structure.at_step=20"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 19));

  run->send(SIGINT);
  std::this_thread::sleep_for(10ms);
  run->send(SIGTERM);

  check_stopped(folder, run->wait(), "SIGINT");
}

TEST_CASE("a second signal ends the run at once, even within a call that never returns")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  for (const bool is_process : {true, false}) {
    CAPTURE(is_process);
    std::filesystem::remove_all(folder / "out");
    const auto run = folder.start(
        test::long_piston({"structure.fault=hang", "structure.at_step=20"}, {is_process ? "--processes" : "--inline"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 19));

    run->send(SIGINT);
    std::this_thread::sleep_for(200ms);
    const bool has_waited = run->is_running();
    run->send(SIGINT);
    const bool is_deserted = folder.is_deserted_within(1s);
    const auto result = run->wait();

    CHECK(has_waited);
    CHECK(is_deserted);
    test::check_failed(
        folder, result, 1,
        {"run 'faulty': ended at once by a second signal", "module 'structure' (faulty_structure", "in step, step 20"});
    CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
  }
}

TEST_CASE("Ctrl-Z stops every process and the deadlines, and the run goes on as if nothing had been")
{
  const test::RunFolder folder;
  auto clean = test::piston({}, {"--inline"});
  clean.out = "clean";
  REQUIRE(folder.run(clean).exit_code == 0);
  // a call of 0.4 s of work, a deadline of 0.8 s, a pause of 1.2 s within the call
  const auto run = folder.start(test::piston(
      {"structure.fault=slow", "structure.at_step=20", "structure.duration=0.4", "run.call_deadline=0.8"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 19));

  run->send(SIGTSTP);
  CHECK(test::wait_until([&] { return are_all(folder.processes(), 'T'); }, 1s));
  CHECK(folder.processes().size() == 6);
  std::this_thread::sleep_for(1200ms);
  CHECK(are_all(folder.processes(), 'T'));
  run->send(SIGCONT);
  const auto result = run->wait();

  CAPTURE(result.err);
  CHECK(result.exit_code == 0);
  CHECK(test::difference(folder / "out", folder / "clean") == "");
  test::check_nothing_left(folder);
}

TEST_CASE("Ctrl-Z stops a run that is busy with short calls as well, again and again")
{
  const test::RunFolder folder;
  const auto run = folder.start(test::long_piston({"run.end_time=1000", "run.call_deadline=0.2"}));
  for (int i = 0; i < 5; ++i) {
    REQUIRE(folder.wait_for_step(test::piston_name, 10 * i + 10));

    run->send(SIGTSTP);
    CHECK(test::wait_until([&] { return are_all(folder.processes(), 'T'); }, 1s));
    std::this_thread::sleep_for(250ms); // beyond the deadline
    CHECK(are_all(folder.processes(), 'T'));
    run->send(SIGCONT);
  }
  CHECK(folder.wait_for_step(test::piston_name, 60));
  run->send(SIGINT);

  const auto result = run->wait();
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  test::check_nothing_left(folder);
}

TEST_CASE("a Ctrl-Z that is taken back at once does not lose the run")
{
  const test::RunFolder folder;
  const auto run = folder.start(test::long_piston({"run.end_time=1000"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 1));

  for (int i = 0; i < 20; ++i) {
    run->send(SIGTSTP);
    std::this_thread::sleep_for(std::chrono::microseconds(50 * i));
    run->send(SIGCONT);
    std::this_thread::sleep_for(5ms);
  }
  const auto steps = folder.steps_of(test::piston_name);
  CHECK(folder.wait_for_step(test::piston_name, steps + 10));
  run->send(SIGINT);

  CHECK(run->wait().exit_code == 0);
}

TEST_CASE("mullion ps shows a live run, mullion stop ends it at the next step")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 10));

  const auto seen = folder.command({"ps"});
  const auto stop = folder.command({"stop", test::piston_name});
  const auto result = run->wait();
  const auto seen_after = folder.command({"ps"});

  CHECK(seen.exit_code == 0);
  CHECK(has(seen.out, "faulty "));
  CHECK(has(seen.out, " " + std::to_string(run->pid()) + " "));
  CHECK(has(seen.out, "/20000 "));
  CHECK(stop.exit_code == 0);
  CHECK(stop.out == "run 'faulty' ends after the step at hand\n");
  check_stopped(folder, result, "mullion stop");
  CHECK(seen_after.out == "no live runs\n");
}

TEST_CASE("mullion stop of a run that is not there says what is")
{
  const test::RunFolder folder;
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 1));

  const auto result = folder.command({"stop", "faultz"});

  CHECK(result.exit_code == 2);
  CHECK(result.err == "mullion: error: no run named 'faultz' is alive; did you mean 'faulty'?\n");
}

TEST_CASE("a second run of a live name is refused with the first one's process")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 1));

  auto again = test::long_piston();
  again.out = "again";
  const auto second = folder.run(again);
  const bool is_first_alive = run->is_running();
  run->send(SIGINT);

  CHECK(second.exit_code == 2);
  CHECK(test::error_messages(second).size() == 1);
  CHECK(
      has(second.err, "mullion: error: a run named 'faulty' is alive (process " + std::to_string(run->pid()) + "); "));
  CHECK(!std::filesystem::exists(folder / "again"));
  CHECK(is_first_alive);
  check_stopped(folder, run->wait(), "SIGINT");
}

TEST_CASE("a runtime folder that others may write to, or that is somebody else's, is refused")
{
  namespace fs = std::filesystem;
  const auto check_refused = [](const test::RunFolder& folder) {
    const auto result = folder.run(test::piston());
    CAPTURE(result.err);
    CHECK(result.exit_code == 1);
    REQUIRE(test::error_messages(result).size() == 1);
    CHECK(has(result.err, "the runtime folder '" + folder.runtime().string() + "'"));
    CHECK(has(result.err, "set MULLION_RUNTIME_DIR to a folder of your own"));
    CHECK(!fs::exists(folder / "out"));
    test::check_nothing_left(folder);
  };

  const test::RunFolder open, foreign, elsewhere;
  fs::create_directory(open.runtime());
  fs::permissions(open.runtime(), fs::perms::all);
  check_refused(open);

  fs::create_directory_symlink(elsewhere.path(), foreign.runtime()); // a link that somebody put there
  const auto linked = foreign.run(test::piston());
  CHECK(linked.exit_code == 1);
  fs::remove(foreign.runtime());

  if (::getuid() != 0) return; // only root can make a folder that is somebody else's
  fs::create_directory(foreign.runtime());
  fs::permissions(foreign.runtime(), fs::perms::owner_all);
  REQUIRE(::chown(foreign.runtime().c_str(), 65534, 65534) == 0);
  check_refused(foreign);
}
