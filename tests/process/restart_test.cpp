// Checkpoints, and what they are for: a run that was killed goes on with one command and ends with the bytes of one
// that never stopped; what fails twice ends with the last good state on disk.
#include "support/faulty_piston.hpp"
#include "support/history.hpp"
#include "support/replaced_hosts.hpp"

#include "io/atomic_file.hpp"
#include "io/checkpoint.hpp"
#include "io/checkpoint_files.hpp"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <sys/resource.h>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;

namespace {

namespace fs = std::filesystem;

/// The long piston with a checkpoint every 250 of its 20,000 steps.
test::CaseRun with_checkpoints(std::vector<std::string> sets = {}, const std::vector<std::string>& flags = {})
{
  sets.insert(sets.begin(), "output.checkpoint_every=250");
  return test::long_piston(sets, flags);
}

/// Kill orchestrators (or guards) at random moments of their lives, and go on with --restart latest each time.
void kill_and_go_on(int times)
{
  const unsigned seed = std::random_device{}();
  MESSAGE("seed ", seed);
  CAPTURE(seed);
  std::mt19937 random(seed);
  const test::RunFolder folder;
  test::run_whole(folder);
  int n_restarts = 0;
  for (int kill = 0; kill < times;) {
    const bool is_restart = !io::list_checkpoints(folder / "out").empty();
    std::vector<std::string> flags{std::uniform_int_distribution(0, 1)(random) == 0 ? "--inline" : "--processes"};
    if (is_restart) flags.insert(flags.end(), {"--restart", "latest"});
    const auto run = folder.start(with_checkpoints({}, flags));
    const auto delay = std::chrono::microseconds(std::uniform_int_distribution(0, 500'000)(random));
    std::this_thread::sleep_for(delay);
    if (run->is_running()) {
      const bool is_guard = std::uniform_int_distribution(0, 3)(random) == 0;
      const auto orchestrator = is_guard ? run->pid() : test::find_orchestrator(folder, run->pid());
      if (orchestrator != 0) ::kill(orchestrator, SIGKILL);
      ++kill;
    }
    const auto result = run->wait();
    REQUIRE(folder.is_deserted_within(2s));
    CHECK(result.exit_code != 2); // refused
    n_restarts += is_restart ? 1 : 0;
    for (const auto& file : io::list_checkpoints(folder / "out")) CHECK_NOTHROW((void)io::read_checkpoint(file.path));
    if (result.exit_code != 0) continue;
    CHECK(test::difference(folder / "out", folder / "whole") == "");
    fs::remove_all(folder / "out"); // and once more from the beginning
  }
  if (io::list_checkpoints(folder / "out").empty()) return;

  const auto result = folder.run(with_checkpoints({}, {"--restart", "latest"}));

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::difference(folder / "out", folder / "whole") == "");
  MESSAGE(n_restarts, " restarts");
}

/// What `mullion run` without a case says, and what it leaves, in the folder `out`.
test::ProcessResult go_on(const test::RunFolder& folder, std::vector<std::string> more)
{
  more.insert(more.begin(), {"run", "--out", "out", "--restart", "latest"});
  return folder.command(more);
}

} // namespace

TEST_CASE("a run whose orchestrator is killed at random moments goes on with --restart latest to the same bytes")
{
  kill_and_go_on(3);
}

TEST_SUITE("full")
{
  TEST_CASE("a run whose orchestrator is killed 50 times goes on with --restart latest to the same bytes")
  {
    kill_and_go_on(50);
  }
}

TEST_CASE("a run that was stopped goes on without its case, to the same bytes")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 100));
  CHECK(folder.command({"stop", test::piston_name}).exit_code == 0);
  const auto stopped = run->wait();
  REQUIRE(stopped.exit_code == 0);
  CHECK(has(stopped.err, "go on with --restart"));

  const auto result = go_on(folder, {"--inline"});

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::difference(folder / "out", folder / "whole") == "");
  const auto record = test::read_record(folder / "out");
  CHECK(record.at("outcome") == "completed");
  REQUIRE(record.at("attempts").size() == 2);
  CHECK(record.at("attempts")[0].at("outcome") == "stopped");
  const auto& second = record.at("attempts")[1];
  CHECK(has(second.at("restarted_from").get<std::string>(), "out/checkpoint-"));
  CHECK(second.at("first_step") == record.at("attempts")[0].at("steps"));
  for (const auto& module : second.at("modules")) CHECK(module.at("process") == false);
}

TEST_CASE("a checkpoint that cannot be written is told, the run goes on, and the one before stays good")
{
  // A limit on file sizes stands for a full disk: the same call fails, without a file system of the test's own.
  const test::RunFolder folder;
  const auto run = folder.start(with_checkpoints({"output.history=false", "output.every=0", "run.end_time=1000"}));
  REQUIRE(test::wait_until([&] { return !io::list_checkpoints(folder / "out").empty(); }));
  const auto orchestrator = test::find_orchestrator(folder, run->pid());
  const auto size = fs::file_size(io::list_checkpoints(folder / "out").front().path);
  rlimit before{};
  REQUIRE(::prlimit(orchestrator, RLIMIT_FSIZE, nullptr, &before) == 0);
  const rlimit small{size / 2, before.rlim_max};
  REQUIRE(::prlimit(orchestrator, RLIMIT_FSIZE, &small, nullptr) == 0);
  REQUIRE(test::wait_until([&] { return has(run->err(), "no checkpoint of step "); }));

  const auto kept = io::newest_good_checkpoint(folder / "out");
  REQUIRE(kept);
  const auto step = folder.steps_of(test::piston_name);
  CHECK(folder.wait_for_step(test::piston_name, step + 300)); // it goes on
  REQUIRE(::prlimit(orchestrator, RLIMIT_FSIZE, &before, nullptr) == 0);
  CHECK(test::wait_until([&] { return io::list_checkpoints(folder / "out").front().step > kept->step + 250; }));
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.err,
            "the limit on file sizes (ulimit -f) is too small; the run goes on, older checkpoints are whole"));
  test::check_nothing_left(folder);
}

TEST_CASE("a checkpoint on a disk that is full is told, the run goes on, and the one before stays good")
{
  // A small file system in memory, in a mount namespace of its own: it goes with the run.
  const test::RunFolder folder;
  fs::create_directory(folder / "disk");
  std::vector<std::string> before{"unshare", "-m"};
  const auto try_it = [&] {
    auto command = before;
    command.insert(command.end(), {"sh", "-c", "mount -t tmpfs -o size=64k none \"$0\"", (folder / "disk").string()});
    try {
      return test::run_process(command).exit_code == 0;
    } catch (const std::exception&) { // there is no such program
      return false;
    }
  };
  if (!try_it()) {
    before = {"unshare", "-rm"};
    if (!try_it()) {
      MESSAGE("skipped: 1 test case; this machine lets nobody mount a file system in a namespace of his own, so the "
              "limit on file sizes alone stands for a full disk");
      return;
    }
  }
  before.insert(before.end(),
                {"sh", "-c", "mount -t tmpfs -o size=8m none \"$0\" && exec \"$@\"", (folder / "disk").string()});
  const auto the_case = with_checkpoints({"output.history=false", "output.every=0", "run.end_time=1000"});
  auto command = before;
  command.insert(command.end(),
                 {MULLION_BUILD_DIR "/bin/mullion", "run", the_case.file, "--out", (folder / "disk/out").string()});
  for (const auto& set : the_case.sets) command.insert(command.end(), {"--set", set});
  const auto run = std::make_unique<test::Process>(
      command, test::ProcessOptions{.environment = {{"MULLION_RUNTIME_DIR", folder.runtime().string()},
                                                    {"MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR}},
                                    .folder = folder.path().string()});
  const auto disk = fs::path("/proc") / std::to_string(run->pid()) / "root" / (folder / "disk").relative_path();
  const auto newest = [&] {
    const auto files = io::list_checkpoints(disk / "out");
    return files.empty() ? std::int64_t{-1} : files.front().step;
  };
  REQUIRE(test::wait_until([&] { return newest() > 0; }));

  // More than once: a checkpoint that was under way makes room, for when it is there an older one is removed.
  REQUIRE(test::wait_until([&] {
    std::ofstream ballast(disk / "ballast", std::ios::binary | std::ios::app);
    const std::string page(4096, '.');
    while (ballast.write(page.data(), 4096).flush()) continue;
    return has(run->err(), "no checkpoint of step ");
  }));
  const auto kept = io::newest_good_checkpoint(disk / "out");
  const auto step = folder.steps_of(test::piston_name);
  CHECK(folder.wait_for_step(test::piston_name, step + 300)); // it goes on
  REQUIRE(kept);
  fs::remove(disk / "ballast");
  CHECK(test::wait_until([&] { return newest() > kept->step + 250; })); // and writes them again
  CHECK(io::newest_good_checkpoint(disk / "out"));
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.err, "No space left on device; make room on that disk or choose another folder with --out; the run "
                        "goes on, older checkpoints are whole"));
  test::check_nothing_left(folder);
}

TEST_CASE("a run that is checkpointed, swapped, stopped and restarted by commands ends as one that only was swapped")
{
  // Inline the swap is done between two steps: the one that takes two seconds, in which it is asked for, and the next.
  const test::RunFolder folder;
  const fs::path built = MULLION_TEST_PLUGIN_DIR "/faulty_structure.so";
  const auto other_build = folder / "faulty_structure_again.so";
  fs::copy_file(built, other_build);
  std::ofstream(other_build, std::ios::app) << "another build"; // the same code, to whoever does not compare
  const auto start = [&](const std::string& out) {
    auto run = test::long_piston({"run.end_time=1.8283482006601323", "output.every=15000", // 300,000 steps
                                  "output.history_every=10", "structure.fault=slow", "structure.at_step=20",
                                  "structure.duration=2.0"},
                                 {"--inline"});
    run.out = out;
    return folder.start(run);
  };
  const auto swap = [&] {
    REQUIRE(folder.wait_for_step(test::piston_name, 19));
    return folder.command(
        {"swap", test::piston_name, "structure=" + other_build.string(), "--set", "damping=1e4", "--set", "mass=500"});
  };
  const auto whole = start("whole");
  const auto undisturbed_swap = swap();
  CHECK_MESSAGE(undisturbed_swap.exit_code == 0, undisturbed_swap.err);
  CHECK(has(undisturbed_swap.out, "; at work from step 21 on"));
  REQUIRE(whole->wait().exit_code == 0);
  REQUIRE(test::last_step(folder / "whole") == 300'000);

  const auto run = start("out");
  REQUIRE(folder.wait_for_step(test::piston_name, 10));
  const auto swapped = swap();
  const auto checkpoint = folder.command({"checkpoint", test::piston_name});
  const auto stop = folder.command({"stop", test::piston_name});
  const auto stopped = run->wait();
  const auto stopped_at = test::last_step(folder / "out");
  const auto rest = go_on(folder, {"--inline"});

  CHECK(has(swapped.out, "; at work from step 21 on"));
  CHECK_MESSAGE(checkpoint.exit_code == 0, checkpoint.err);
  CHECK(has(checkpoint.out, "checkpoint of step "));
  CHECK(stop.exit_code == 0);
  CHECK_MESSAGE(stopped.exit_code == 0, stopped.err);
  CHECK(stopped_at >= 21);
  CHECK(stopped_at < 300'000);
  CHECK_MESSAGE(rest.exit_code == 0, rest.err);
  CHECK(test::difference(folder / "out", folder / "whole") == "");
  CHECK_MESSAGE(has(rest.err, "was made with other plug-ins (structure: another build of faulty_structure 0.1.0); the "
                              "results may differ from those of a run that never stopped"),
                rest.err);
}

TEST_CASE("what fails twice in the same step ends the run with a post-mortem and the last good state on disk")
{
  const test::RunFolder folder;
  REQUIRE(folder.run(test::piston({"structure.mass=520"}, {"--inline"})).exit_code == 0);
  fs::rename(folder / "out", folder / "whole");

  const auto result = folder.run(
      test::piston({"run.on_failure=respawn", "structure.fault=segfault", "structure.at_step=30"}, {"--processes"}));

  test::check_failed(folder, result, 1,
                     {"module 'structure' (faulty_structure, process ",
                      "was killed by signal 11 (SIGSEGV), in step, "
                      "step 30, t = ",
                      "the same had happened before in this step, which ends the run"});
  CHECK(has(result.err, "respawned 'structure', step 30 is done again from the last commit"));
  const auto post_mortem = test::read_file(folder / "out/post-mortem.txt");
  for (const char* part : {"module 'structure' (faulty_structure, process ", "was killed by signal 11 (SIGSEGV)",
                           "in step, step 30, t = ", "its last lines:", "faulty_structure.so"}) // the backtrace
    CHECK_MESSAGE(has(post_mortem, part), post_mortem);
  const auto events = test::read_record(folder / "out").at("attempts")[0].at("events");
  REQUIRE(events.size() == 1);
  CHECK(events[0].at("what") == "respawn");
  CHECK(events[0].at("instance") == "structure");
  CHECK(events[0].at("step") == 30);
  CHECK(fs::exists(folder / "out" / io::checkpoint_name(29)));

  const auto mended = go_on(folder, {"--set", "structure.fault=none", "--set", "structure.at_step=1"});

  CHECK_MESSAGE(mended.exit_code == 0, mended.err);
  CHECK(test::difference(folder / "out", folder / "whole") == "");
}

TEST_CASE("a run that ends with a number that is none leaves its last good state")
{
  for (const char* placement : {"--inline", "--processes"}) {
    const test::RunFolder folder;
    const auto result = folder.run(test::piston({"structure.fault=not_a_number", "structure.at_step=30"}, {placement}));

    test::check_failed(folder, result, 1, {"structure/wet.velocity[0, 0] = nan"});
    CHECK(io::list_checkpoints(folder / "out").size() == 1);
    CHECK(io::read_checkpoint(folder / "out" / io::checkpoint_name(29)).clock.step == 29);
  }
}

TEST_CASE("a module that dies in a start-up gets a second chance, and no third")
{
  for (const char* call : {"define", "attach", "start"}) {
    CAPTURE(call);
    const test::RunFolder folder;
    REQUIRE(folder.run(test::piston({}, {"--inline"})).exit_code == 0);
    fs::rename(folder / "out", folder / "whole");
    const std::vector<std::string> sets{"run.on_failure=respawn", "structure.at=" + std::string(call)};
    auto slow = sets, dies = sets;
    slow.insert(slow.end(), {"structure.fault=slow", "structure.duration=0.5"});
    dies.emplace_back("structure.fault=abort");

    const auto run = folder.start(test::piston(slow));
    const auto host = test::find_host(folder, 1);
    std::this_thread::sleep_for(200ms);
    ::kill(host, SIGKILL);
    const auto result = run->wait();

    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(has(result.err, fmt::format("was killed by signal 9 (SIGKILL), in {}, before the first step; the start-up is "
                                      "done again from the beginning",
                                      call)));
    CHECK(test::difference(folder / "out", folder / "whole") == "");
    test::check_failed(folder, folder.run(test::piston(dies)), 1,
                       {fmt::format("was killed by signal 6 (SIGABRT), in {}, before the first step", call)});
    CHECK(io::list_checkpoints(folder / "out").empty()); // there never was a state worth keeping
  }
}

TEST_CASE("a host that is killed while it is started anew is started once more")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston(
      {"run.on_failure=respawn", "structure.fault=slow", "structure.at=attach", "structure.duration=0.4"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 10));

  auto host = test::find_host(folder, 1);
  for (int n = 0; n < 2; ++n) {
    ::kill(host, SIGKILL);
    REQUIRE(test::wait_until([&] {
      const auto next = test::find_host(folder, 1);
      return next != 0 && next != std::exchange(host, next != 0 ? next : host);
    }));
    std::this_thread::sleep_for(100ms); // it is in its attach
  }
  REQUIRE(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 10));
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.err, "was killed by signal 9 (SIGKILL), in attach, after step"));
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
}

TEST_CASE("a host that hangs past its deadline is replaced, and the bytes are those of an undisturbed run")
{
  const test::RunFolder folder;
  test::run_whole(folder);
  const auto run = folder.start(test::long_piston({"run.on_failure=respawn", "run.call_deadline=0.5"}));
  test::replace_each_host(folder, [](pid_t host) { ::kill(host, SIGSTOP); });
  run->send(SIGINT);
  const auto result = run->wait();

  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.err, "did not answer within its deadline of 0.5 s"));
  CHECK(test::difference_of_part(folder / "out", folder / "whole") == "");
  CHECK(test::read_record(folder / "out").at("attempts")[0].at("events").size() == 4);
  test::check_nothing_left(folder);
}

TEST_CASE("a step that diverges is halved where the case says so, and the run comes back to its times")
{
  // At sixteen times the usual step (Courant number 1.6) the gas holds for a few steps only.
  const std::vector<std::string> sets{"run.dt=9.751190403520706e-5", "run.end_time=1.95023808070414e-3", // 20 steps
                                      "driver.scheme=gss",           "output.every=5",
                                      "output.checkpoint_every=1",   "output.keep_checkpoints=0"};
  auto halved = sets;
  halved.emplace_back("run.on_divergence=halve_dt");
  const auto piston = [](const std::vector<std::string>& with, const std::vector<std::string>& flags,
                         const std::string& out) {
    return test::CaseRun{
        .file = MULLION_SOURCE_DIR "/configs/closed_piston.toml", .sets = with, .flags = flags, .out = out};
  };
  const test::RunFolder folder;

  const auto stopped = folder.run(piston(sets, {"--inline"}, "stopped"));
  const auto whole = folder.run(piston(halved, {"--inline"}, "whole"));

  CHECK(stopped.exit_code == 1);
  CHECK_MESSAGE(whole.exit_code == 0, whole.err);
  CHECK(has(whole.err, "is done again with dt = 4.875595201760353e-05 s"));
  const auto times = test::read_history(folder / "whole/history.csv").at("time");
  CHECK(times.size() > 21);    // a row for each half, too
  for (int n = 0; n < 20; ++n) // and all of the plan's times, to the last bit
    CHECK(std::count(times.begin(), times.end(), n * 9.751190403520706e-5) == 1);
  CHECK(times.back() == 1.95023808070414e-3);
  std::size_t n_files = 0;
  for (const auto& entry : fs::directory_iterator(folder / "whole/results")) n_files += entry.is_regular_file() ? 1 : 0;
  CHECK(n_files == 1 + 5); // the mesh, and results at whole steps 0, 5, 10, 15, 20

  for (const auto& file : io::list_checkpoints(folder / "whole")) { // also in the midst of a halved step
    fs::remove_all(folder / "out");
    fs::copy(folder / "whole", folder / "out", fs::copy_options::recursive);
    const auto from = "out/" + file.path.filename().string();
    const auto rest = folder.run(piston(halved, {"--processes", "--restart", from}, "out"));
    CHECK_MESSAGE(rest.exit_code == 0, rest.err);
    CHECK(test::difference(folder / "out", folder / "whole") == "");
  }
}
