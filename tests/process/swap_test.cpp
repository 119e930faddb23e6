// Other code at work in a live run: the same code leaves no trace in the results, a candidate that does not fit or
// fails leaves none either, other parameters do what a run with them does from there on.
#include "process/run_socket.hpp"
#include "support/faulty_piston.hpp"
#include "support/steered_piston.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;
namespace fs = std::filesystem;

namespace {

constexpr const char* plugins[] = {"euler_1d", "faulty_structure", "stretch_1d", "point_transfer"};

/// The bytes of a library with some more behind them: another build to whoever compares, the same code to the loader.
fs::path another_build(const test::RunFolder& folder, const std::string& plugin)
{
  const fs::path built = MULLION_BUILD_DIR "/lib/mullion/plugins/" + plugin + ".so";
  const fs::path tests = MULLION_TEST_PLUGIN_DIR "/" + plugin + ".so";
  const auto copy = folder / (plugin + "_again.so");
  fs::copy_file(fs::exists(built) ? built : tests, copy, fs::copy_options::overwrite_existing);
  std::ofstream(copy, std::ios::app) << "another build";
  return copy;
}

void rest_a_moment(std::mt19937& random)
{
  std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 20'000)(random)));
}

} // namespace

TEST_CASE("a swap to the same code leaves the bytes of the results as they are, whatever is swapped and where it runs")
{
  const unsigned seed = std::random_device{}();
  CAPTURE(seed);
  std::mt19937 random(seed);
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where});

    for (int module = 0; module < 4; ++module) {
      rest_a_moment(random);
      const std::string instance = test::instances[module];
      const bool is_again = module % 2 == 1;
      const auto plugin = is_again ? another_build(folder, plugins[module]).string() : std::string(plugins[module]);

      const auto swap = folder.command({"swap", test::piston_name, instance + "=" + plugin});

      CAPTURE(swap.err);
      CHECK(swap.exit_code == 0);
      CHECK(has(swap.out, instance + ": " + plugins[module] + " 0.1.0 for " + plugins[module] + " 0.1.0, from "));
      CHECK(has(swap.out, "; at work from step "));
    }
    const auto processes = folder.processes();
    CHECK(processes.size() == (where == std::string("--inline") ? 2 : 6)); // those that were parked have gone
    test::check_undisturbed(folder, *run);
    CHECK(test::events(folder) ==
          std::vector<std::string>{"swap fluid", "swap structure", "swap mesh_motion", "swap transfer"});
  }
}

TEST_CASE("a candidate that does not fit, or cannot attach, is refused with the reason and disturbs nothing")
{
  struct Refusal {
    std::string what, reason;
    std::vector<std::string> sets{};
    int exit_code = 2;
  };
  const auto refusals = [](const test::RunFolder& folder) {
    std::ofstream(folder / "text.so") << "this is no library";
    const std::string tests = MULLION_TEST_PLUGIN_DIR "/";
    return std::vector<Refusal>{
        {"structure=wrong_fit_structure",
         "wrong_fit_structure does not fit the windows of 'structure': wet.displacement is there, the candidate does "
         "not declare it; "},
        {"structure=wrong_fit_structure",
         "wet.velocity is 'on node', the candidate has 'on element'; wet.velocity is 'intensive', the candidate has "
         "'extensive'; "},
        {"structure=wrong_unit_structure", "wet.traction (received) is 'unit Pa', the candidate has 'unit psi'"},
        {"structure=euler_1d", "euler_1d is a fluid, 'structure' is a structure"},
        {"structure=faulty_structur", "there is no plug-in 'faulty_structur'; did you mean 'faulty_structure'?"},
        {"structur=faulty_structure", "the run has no module 'structur'; did you mean 'structure'?"},
        {"fluid=" + tests + "wrong_abi.so", "wrong_abi.so: built for plug-in ABI 999"},
        {"fluid=" + tests + "nowhere.so", "nowhere.so: No such file or directory"},
        {"fluid=" + (folder / "text.so").string(), "text.so: file too short"},
        {"structure=faulty_structure", "has no parameter 'mas'; did you mean 'mass'?", {"mas=3"}},
        {"structure=faulty_structure", "mass = -3 is out of range; expected a number > 0 [kg]", {"mass=-3"}},
        {"structure=faulty_structure",
         "'structure' (faulty_structure): with origin = 2.0 the window structure/wet would have another size, mesh or "
         "fixed field; a live run keeps these as they are",
         {"origin=2.0"}},
        {"structure=faulty_structure",
         "'structure' (faulty_structure): with first_displacement = 1e-3 the first values of "
         "structure/wet.displacement would be others; a live run is past these, and what only they depend on would "
         "change nothing",
         {"mass=600", "first_displacement=1e-3"}},
        {"structure=faulty_structure",
         "window structure/wet keeps 1 committed level; level -2 was asked for (the driver of a run says how many each "
         "window keeps, and no module can have more)",
         {"fault=look_back", "at=attach"}},
        {"driver=strong", "a driver cannot be swapped: what css connects and keeps is made for the whole run; 'mullion "
                          "set' changes its parameters (driver.NAME=VALUE), another scheme is another run"},
    };
  };
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where});

    for (const auto& refusal : refusals(folder)) {
      CAPTURE(refusal.what);
      std::vector<std::string> command{"swap", test::piston_name, refusal.what};
      for (const auto& set : refusal.sets) command.insert(command.end(), {"--set", set});
      const auto swap = folder.command(command);
      CHECK(swap.exit_code == refusal.exit_code);
      CHECK(test::error_messages(swap).size() == 1);
      CHECK_MESSAGE(has(swap.err, refusal.reason), swap.err);
    }
    test::check_undisturbed(folder, *run);
    CHECK(test::events(folder).empty());
  }
}

TEST_CASE("a candidate in a process may die or write into the windows while it attaches: it has no right to")
{
  const test::RunFolder folder;
  const auto run = test::live_piston(folder, {"--processes"});
  for (const auto& [fault, reason] :
       std::vector<std::pair<std::string, std::string>>{{"abort", "was killed by signal 6 (SIGABRT), in attach"},
                                                        {"exit", "exited with code 3, in attach"},
                                                        {"garbage_window", "(SIGSEGV) after a write into the read-only "
                                                                           "window structure/wet"}}) {
    const auto swap = folder.command(
        {"swap", test::piston_name, "structure=faulty_structure", "--set", "fault=" + fault, "--set", "at=attach"});
    CHECK(swap.exit_code == 2);
    CHECK_MESSAGE(has(swap.err, reason), swap.err);
  }
  test::check_undisturbed(folder, *run);
}

namespace {

/// Until there is a fifth host. The command that asks for the swap is a process of the run's folder, too.
bool wait_for_candidate(const test::RunFolder& folder)
{
  return test::wait_until([&] {
    const auto processes = folder.processes();
    return std::count_if(processes.begin(), processes.end(), [](const auto& process) { return process.is_host(); }) ==
           5;
  });
}

/// Until a command talks to the run: on a busy machine another one that was started later may come first.
bool wait_for_connection(const test::Process& command)
{
  return test::wait_until([&] {
    std::error_code gone; // files close while we look
    for (const auto& file : fs::directory_iterator(fmt::format("/proc/{}/fd", command.pid()), gone))
      if (fs::read_symlink(file.path(), gone).string().starts_with("socket:")) return true;
    return false;
  });
}

} // namespace

TEST_CASE("a candidate in a process that attaches slowly does not hold the run, and what it derived is of the exchange")
{
  const test::RunFolder folder;
  const auto run = test::live_piston(folder, {"--processes"});
  // The second derives from what is committed when it attaches, and its first step looks whether it still is.
  for (const char* fault : {"slow", "derive"}) {
    CAPTURE(fault);
    const auto swap =
        folder.start_command({"swap", test::piston_name, "structure=faulty_structure", "--set",
                              "fault=" + std::string(fault), "--set", "at=attach", "--set", "duration=2.0"});
    REQUIRE(wait_for_candidate(folder));

    const auto then = folder.steps_of(test::piston_name);
    CHECK(folder.wait_for_step(test::piston_name, then + 20));
    CHECK(swap->is_running());
    const auto result = swap->wait();

    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(has(result.out, "; at work from step "));
    CHECK(folder.processes().size() == 6);
  }
  test::check_undisturbed(folder, *run);
}

TEST_CASE("while a candidate attaches a checkpoint is written, other changes wait, and the end of the run ends it")
{
  const test::RunFolder folder;
  const auto run = test::live_piston(folder, {"--processes"});
  const auto swap = folder.start_command(
      {"swap", test::piston_name, "structure=faulty_structure", "--set", "fault=hang", "--set", "at=attach"});
  REQUIRE(wait_for_candidate(folder));

  const auto set = folder.start_command({"set", test::piston_name, "structure.mass=600"});
  REQUIRE(wait_for_connection(*set));
  const auto checkpoint = folder.command({"checkpoint", test::piston_name});

  CHECK_MESSAGE(checkpoint.exit_code == 0, checkpoint.err);
  CHECK(swap->is_running());
  CHECK(set->is_running());
  test::check_undisturbed(folder, *run);
  const auto swapped = swap->wait(), changed = set->wait();
  CHECK(swapped.exit_code == 1);
  CHECK_MESSAGE(has(swapped.err, "the run ended before the candidate had attached"), swapped.err);
  CHECK(changed.exit_code == 1);
  CHECK_MESSAGE(has(changed.err, "the run ended before it came to that"), changed.err);
}

TEST_CASE("a candidate that never attaches is killed at the deadline, and one that is killed is refused")
{
  const test::RunFolder folder;
  const auto run = test::live_piston(folder, {"--processes"}, {"run.start_deadline=4"});
  const auto before = folder.processes();
  const auto hang = [&] {
    return folder.start_command(
        {"swap", test::piston_name, "structure=faulty_structure", "--set", "fault=hang", "--set", "at=attach"});
  };

  const auto late = hang()->wait();
  const auto killed = hang();
  pid_t candidate = 0;
  REQUIRE(test::wait_until([&] {
    for (const auto& process : folder.processes())
      if (process.is_host() &&
          std::none_of(before.begin(), before.end(), [&](const auto& other) { return other.pid == process.pid; }))
        candidate = process.pid;
    return candidate != 0;
  }));
  ::kill(candidate, SIGKILL);
  const auto dead = killed->wait();

  CHECK(late.exit_code == 2);
  CHECK_MESSAGE(has(late.err, "did not attach within its deadline of 4 s and was killed"), late.err);
  CHECK(dead.exit_code == 2);
  CHECK_MESSAGE(has(dead.err, "was killed by signal 9 (SIGKILL)"), dead.err);
  CHECK(folder.processes().size() == 6);
  test::check_undisturbed(folder, *run);
}

TEST_CASE(
    "a swap changes what is not declared changeable if the windows and first states stay, inline and in processes")
{
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where});

    const auto set = folder.command({"set", test::piston_name, "structure.damping=1e4"});
    const auto swap = folder.command({"swap", test::piston_name, "structure=faulty_structure", "--set", "damping=1e4"});
    REQUIRE(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 1000));
    run->send(SIGINT);
    const auto result = run->wait();

    CHECK(set.exit_code == 2); // that stays with what is declared
    CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    CHECK(has(swap.out, ", damping = 1e4; at work from step "));
    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(test::difference_of_part(folder / "out", test::whole_piston()) != ""); // it is at work
    CHECK(folder.is_deserted_within(1s));                                        // no process that defined is left
  }
}

TEST_CASE("when a candidate fails in its first step, the one before it takes over and the bytes are the same")
{
  const test::RunFolder folder;
  struct Failure {
    std::string fault, reason;
    bool is_inline_too;
  };
  const std::vector<Failure> failures{
      {"throw", "did not want to go on", true},
      {"throw_foreign", "threw something that is no std::exception", true},
      {"not_a_number", "structure/wet.velocity[0, 0] = ", true},
      {"look_back", "window structure/wet keeps 1 committed level; level -2 was asked for", true},
      {"segfault", "was killed by signal 11 (SIGSEGV)", false},
      {"exit", "exited with code 3", false},
      {"hang", "did not answer within its deadline of 0.5 s", false},
      {"stray_write", "after a write into the read-only window structure/wet.in", false}};
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where}, {"run.call_deadline=0.5"});

    for (const auto& failure : failures) {
      if (where == std::string("--inline") && !failure.is_inline_too) continue;
      const auto swap = folder.command({"swap", test::piston_name, "structure=faulty_structure", "--set",
                                        "fault=" + failure.fault, "--set", "at_step=0"});
      CHECK(swap.exit_code == 1);
      CHECK_MESSAGE(has(swap.err, failure.reason), swap.err);
      CHECK_MESSAGE(has(swap.err, " taken back, the one before it does step "), swap.err);
    }
    CHECK(folder.processes().size() == (where == std::string("--inline") ? 2 : 6));
    test::check_undisturbed(folder, *run);
    CHECK(test::events(folder).front() == "swap taken back structure");
  }
}

TEST_CASE("a run that is swapped and replayed, or redone by fresh processes, in every step agrees with itself")
{
  const test::RunFolder folder;
  for (const auto& flags :
       {std::vector<std::string>{"--replay", "--processes"}, {"--replay", "--inline"}, {"--amnesia", "7"}}) {
    const auto run = test::live_piston(folder, flags);
    for (const int module : {0, 1, 2, 3, 1}) {
      const auto swap =
          folder.command({"swap", test::piston_name, std::string(test::instances[module]) + "=" + plugins[module]});
      CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    }
    test::check_undisturbed(folder, *run);
  }
}

TEST_CASE("another plug-in with the same windows goes on from them, with its own parameters")
{
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    const auto run = test::live_piston(folder, {where});

    const auto swap = folder.command({"swap", test::piston_name, "structure=twin_structure", "--set", "origin=1.0"});
    const auto modules = folder.command({"inspect", test::piston_name});
    const auto back = folder.command({"swap", test::piston_name, "structure=faulty_structure"});

    CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    CHECK(has(swap.out, "structure: twin_structure 0.1.0 for faulty_structure 0.1.0, from "));
    CHECK(has(modules.out, "structure      structure      twin_structure "));
    CHECK_MESSAGE(back.exit_code == 0, back.err);
    test::check_undisturbed(folder, *run); // its defaults are those of the case
  }
}

TEST_CASE("a line that is no command of a run is answered with the nearest one")
{
  const test::RunFolder folder;
  const auto run = folder.start(test::long_piston());
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

  const auto unknown = nlohmann::json::parse(process::ask_run(test::piston_name, "chekpoint"));
  const auto no_json = nlohmann::json::parse(process::ask_run(test::piston_name, "swap {"));
  const auto no_target = nlohmann::json::parse(process::ask_run(test::piston_name, "swap {}"));
  run->send(SIGINT);

  CHECK(unknown.at("error") == "a run knows no command 'chekpoint'; did you mean 'checkpoint'?");
  CHECK(no_json.contains("error"));
  CHECK(no_target.contains("error"));
  CHECK(run->wait().exit_code == 0);
}

TEST_CASE("commands to a run that is not there, and to one that ends meanwhile")
{
  const test::RunFolder folder;
  const auto run = folder.start(test::long_piston({"structure.fault=hang", "structure.at_step=20"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 19));

  const auto unknown = folder.command({"swap", "faultz", "structure=faulty_structure"});
  const auto waiting = folder.start_command({"set", test::piston_name, "structure.mass=520"}); // no boundary comes
  std::this_thread::sleep_for(100ms);
  CHECK(waiting->is_running());
  run->send(SIGKILL);
  const auto result = waiting->wait();

  CHECK(unknown.exit_code == 2);
  CHECK(unknown.err == "mullion: error: no run named 'faultz' is alive; did you mean 'faulty'?\n");
  CHECK(result.exit_code == 1);
  CHECK(result.err == "mullion: error: run 'faulty' ended before it answered\n");
  for (const auto& words : std::vector<std::vector<std::string>>{
           {"swap"}, {"swap", "a"}, {"swap", "a", "b"}, {"swap", "a", "=b"}, {"set", "a"}, {"inspect"}, {"checkpoint"}})
    CHECK(folder.command(words).exit_code == 2);
}
