// Other code at work in a live run: the same code leaves no trace in the results, a candidate that does not fit or
// fails leaves none either, other parameters do what a run with them does from there on.
#include "process/run_socket.hpp"
#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

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

/// Long enough to be disturbed a dozen times even inline, where a step takes some microseconds.
test::CaseRun longer_piston(const std::vector<std::string>& flags, const std::vector<std::string>& sets = {})
{
  std::vector<std::string> all{"run.end_time=1.8283482006601323", "output.every=15000", "output.history_every=10"};
  all.insert(all.end(), sets.begin(), sets.end());
  return test::piston(all, flags);
}

/// Results of the same without disturbance, made once.
std::filesystem::path whole()
{
  static const test::RunFolder folder;
  static const bool is_made = [] {
    auto run = longer_piston({"--inline"}, {"run.name=whole"});
    run.out = "whole";
    return folder.run(run).exit_code == 0;
  }();
  REQUIRE(is_made);
  return folder / "whole";
}

/// End a live run, whose results must be the first part of the undisturbed run's.
void check_undisturbed(const test::RunFolder& folder, test::Process& run)
{
  run.send(SIGINT);
  const auto result = run.wait();
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(test::last_step(folder / "out") > 0);
  CHECK(test::difference_of_part(folder / "out", whole()) == "");
  test::check_nothing_left(folder);
}

void rest_a_moment(std::mt19937& random)
{
  std::this_thread::sleep_for(std::chrono::microseconds(std::uniform_int_distribution(0, 20'000)(random)));
}

std::vector<std::string> events(const test::RunFolder& folder)
{
  std::vector<std::string> found;
  const auto record = test::read_record(folder / "out"); // must outlive the loop over it
  for (const auto& event : record.at("attempts").at(0).at("events"))
    found.push_back(event.at("what").get<std::string>() + " " + event.at("instance").get<std::string>());
  return found;
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
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

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
    check_undisturbed(folder, *run);
    CHECK(events(folder) ==
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
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

    for (const auto& refusal : refusals(folder)) {
      CAPTURE(refusal.what);
      std::vector<std::string> command{"swap", test::piston_name, refusal.what};
      for (const auto& set : refusal.sets) command.insert(command.end(), {"--set", set});
      const auto swap = folder.command(command);
      CHECK(swap.exit_code == refusal.exit_code);
      CHECK(test::error_messages(swap).size() == 1);
      CHECK_MESSAGE(has(swap.err, refusal.reason), swap.err);
    }
    check_undisturbed(folder, *run);
    CHECK(events(folder).empty());
  }
}

TEST_CASE("a candidate in a process may die or write into the windows while it attaches: it has no right to")
{
  const test::RunFolder folder;
  const auto run = folder.start(longer_piston({"--processes"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
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
  check_undisturbed(folder, *run);
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

} // namespace

TEST_CASE("a candidate in a process that attaches slowly does not hold the run, and what it derived is of the exchange")
{
  const test::RunFolder folder;
  const auto run = folder.start(longer_piston({"--processes"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
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
  check_undisturbed(folder, *run);
}

TEST_CASE("while a candidate attaches a checkpoint is written, other changes wait, and the end of the run ends it")
{
  const test::RunFolder folder;
  const auto run = folder.start(longer_piston({"--processes"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
  const auto swap = folder.start_command(
      {"swap", test::piston_name, "structure=faulty_structure", "--set", "fault=hang", "--set", "at=attach"});
  REQUIRE(wait_for_candidate(folder));

  const auto set = folder.start_command({"set", test::piston_name, "structure.mass=600"});
  const auto checkpoint = folder.command({"checkpoint", test::piston_name});

  CHECK_MESSAGE(checkpoint.exit_code == 0, checkpoint.err);
  CHECK(swap->is_running());
  CHECK(set->is_running());
  check_undisturbed(folder, *run);
  const auto swapped = swap->wait(), changed = set->wait();
  CHECK(swapped.exit_code == 1);
  CHECK_MESSAGE(has(swapped.err, "the run ended before the candidate had attached"), swapped.err);
  CHECK(changed.exit_code == 1);
  CHECK_MESSAGE(has(changed.err, "the run ended before it came to that"), changed.err);
}

TEST_CASE("a candidate that never attaches is killed at the deadline, and one that is killed is refused")
{
  const test::RunFolder folder;
  const auto run = folder.start(longer_piston({"--processes"}, {"run.start_deadline=4"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));
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
  check_undisturbed(folder, *run);
}

TEST_CASE(
    "a swap changes what is not declared changeable if the windows and first states stay, inline and in processes")
{
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

    const auto set = folder.command({"set", test::piston_name, "structure.damping=1e4"});
    const auto swap = folder.command({"swap", test::piston_name, "structure=faulty_structure", "--set", "damping=1e4"});
    REQUIRE(folder.wait_for_step(test::piston_name, folder.steps_of(test::piston_name) + 1000));
    run->send(SIGINT);
    const auto result = run->wait();

    CHECK(set.exit_code == 2); // that stays with what is declared
    CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    CHECK(has(swap.out, ", damping = 1e4; at work from step "));
    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(test::difference_of_part(folder / "out", whole()) != ""); // it is at work
    CHECK(folder.is_deserted_within(1s));                           // no process that defined is left
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
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}, {"run.call_deadline=0.5"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

    for (const auto& failure : failures) {
      if (where == std::string("--inline") && !failure.is_inline_too) continue;
      const auto swap = folder.command({"swap", test::piston_name, "structure=faulty_structure", "--set",
                                        "fault=" + failure.fault, "--set", "at_step=0"});
      CHECK(swap.exit_code == 1);
      CHECK_MESSAGE(has(swap.err, failure.reason), swap.err);
      CHECK_MESSAGE(has(swap.err, " taken back, the one before it does step "), swap.err);
    }
    CHECK(folder.processes().size() == (where == std::string("--inline") ? 2 : 6));
    check_undisturbed(folder, *run);
    CHECK(events(folder).front() == "swap taken back structure");
  }
}

TEST_CASE("a run that is swapped and replayed, or redone by fresh processes, in every step agrees with itself")
{
  const test::RunFolder folder;
  for (const auto& flags :
       {std::vector<std::string>{"--replay", "--processes"}, {"--replay", "--inline"}, {"--amnesia", "7"}}) {
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston(flags));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));
    for (const int module : {0, 1, 2, 3, 1}) {
      const auto swap =
          folder.command({"swap", test::piston_name, std::string(test::instances[module]) + "=" + plugins[module]});
      CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    }
    check_undisturbed(folder, *run);
  }
}

TEST_CASE("set changes what is declared changeable from the next step on, and a run with other parameters differs")
{
  const test::RunFolder folder;
  auto every = test::piston({"run.name=every", "run.end_time=0.6094494002200441", "output.every=0"}, {"--inline"});
  every.out = "every";
  REQUIRE(folder.run(every).exit_code == 0);
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}, {"output.history_every=1"}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

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
    CHECK(events(folder) == std::vector<std::string>{"set structure", "set driver"});
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

TEST_CASE("another plug-in with the same windows goes on from them, with its own parameters")
{
  const test::RunFolder folder;
  for (const char* where : {"--inline", "--processes"}) {
    CAPTURE(where);
    fs::remove_all(folder / "out");
    const auto run = folder.start(longer_piston({where}));
    REQUIRE(folder.wait_for_step(test::piston_name, 5));

    const auto swap = folder.command({"swap", test::piston_name, "structure=twin_structure", "--set", "origin=1.0"});
    const auto modules = folder.command({"inspect", test::piston_name});
    const auto back = folder.command({"swap", test::piston_name, "structure=faulty_structure"});

    CHECK_MESSAGE(swap.exit_code == 0, swap.err);
    CHECK(has(swap.out, "structure: twin_structure 0.1.0 for faulty_structure 0.1.0, from "));
    CHECK(has(modules.out, "structure      structure      twin_structure "));
    CHECK_MESSAGE(back.exit_code == 0, back.err);
    check_undisturbed(folder, *run); // its defaults are those of the case
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
  const auto run = folder.start(longer_piston({"--processes"}));
  REQUIRE(folder.wait_for_step(test::piston_name, 5));

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
  check_undisturbed(folder, *run);
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
