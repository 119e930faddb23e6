// A module that misbehaves, in a process of its own and inline, in each of its calls: the run ends with one message
// that names the module, the call, the step and how it ended, and nothing stays behind.
#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

using namespace mullion;
using namespace std::chrono_literals;
using test::has;

namespace {

struct Place {
  std::string at;
  std::string told; ///< how messages name the call
};
const std::vector<Place> places = {{"define", "in define, before the first step"},
                                   {"attach", "in attach, before the first step"},
                                   {"start", "in start, before the first step"},
                                   {"step", "in step, step 7, t = 3.656"}};
const std::vector<Place> inline_places = {{"define", "in define, step 0"},
                                          {"attach", "in attach, step 0"},
                                          {"start", "in start, step 0"},
                                          {"step", "in step, step 7, t = 3.656"}};

test::CaseRun faulty(const std::string& fault, const std::string& at, const std::vector<std::string>& flags = {})
{
  return test::piston({"structure.fault=" + fault, "structure.at=" + at, "structure.at_step=7"}, flags);
}

constexpr const char* in_a_process = "module 'structure' (faulty_structure, process ";
constexpr const char* is_inline = "module 'structure' (faulty_structure, inline)";

} // namespace

TEST_CASE("an exception in a module, in a process or inline, ends the run with its text and the module's name")
{
  for (const auto& [fault, text] : std::map<std::string, std::string>{
           {"throw", "did not want to go on"}, {"throw_foreign", "threw something that is no std::exception"}})
    for (const auto& place : places)
      for (const bool is_process : {true, false}) {
        CAPTURE(fault);
        CAPTURE(place.at);
        CAPTURE(is_process);
        const test::RunFolder folder;

        const auto result = folder.run(faulty(fault, place.at, {is_process ? "--processes" : "--inline"}));

        test::check_failed(folder, result, 1,
                           {is_process ? in_a_process : is_inline, " failed " + place.told, ": " + text});
      }
}

TEST_CASE("a module whose process dies ends the run with the signal or the exit code and the module's name")
{
  for (const auto& [fault, text] : std::map<std::string, std::string>{{"segfault", "was killed by signal 11 (SIGSEGV)"},
                                                                      {"abort", "was killed by signal 6 (SIGABRT)"},
                                                                      {"exit", "exited with code 3"}})
    for (const auto& place : places) {
      CAPTURE(fault);
      CAPTURE(place.at);
      const test::RunFolder folder;

      const auto result = folder.run(faulty(fault, place.at));

      test::check_failed(folder, result, 1, {in_a_process, " " + text + ", " + place.told});
      CHECK(has(test::read_file(folder / "out/post-mortem.txt"), in_a_process));
    }
}

TEST_CASE("an inline module that takes the orchestrator with it is named by the guard")
{
  for (const auto& [fault, text] : std::map<std::string, std::string>{{"segfault", "was killed by signal 11 (SIGSEGV)"},
                                                                      {"abort", "was killed by signal 6 (SIGABRT)"},
                                                                      {"exit", "exited with code 3"}})
    for (const auto& place : inline_places) {
      CAPTURE(fault);
      CAPTURE(place.at);
      const test::RunFolder folder;

      const auto result = folder.run(faulty(fault, place.at, {"--inline"}));

      test::check_failed(
          folder, result, 1,
          {"run 'faulty': the orchestrator (process ", text, std::string("inside ") + is_inline, place.told});
    }
}

TEST_CASE("an inline module that takes the orchestrator with it takes the other modules' processes as well")
{
  const test::RunFolder folder;

  const auto result =
      folder.run(test::piston({"structure.fault=segfault", "structure.at_step=7", "structure.process=false"}));

  test::check_failed(folder, result, 1, {"SIGSEGV", is_inline, "in step, step 7"});
}

TEST_CASE("a module that hangs is killed at its deadline")
{
  for (const auto& place : places) {
    CAPTURE(place.at);
    const test::RunFolder folder;
    auto run = faulty("hang", place.at);
    run.sets.emplace_back(place.at == "step" ? "run.call_deadline=0.3" : "run.start_deadline=0.3");

    const auto result = folder.run(run);

    test::check_failed(folder, result, 1,
                       {in_a_process, "did not answer within its deadline of 0.3 s", place.told,
                        place.at == "step" ? "run.call_deadline" : "run.start_deadline"});
  }
}

TEST_CASE("a value that is not finite is named with the call that made it")
{
  for (const char* where : {"--processes", "--inline"})
    for (const auto& place : places) {
      if (place.at == "attach") continue; // writes nothing
      CAPTURE(place.at);
      const test::RunFolder folder;

      const auto result = folder.run(faulty("not_a_number", place.at, {where}));

      test::check_failed(folder, result, 1,
                         {"module 'structure' (faulty_structure", place.told,
                          "structure/wet.velocity[0, 0] = nan (component, entity): not a finite number"});
    }
}

TEST_CASE("an output that a step leaves out is found by --replay")
{
  for (const char* where : {"--processes", "--inline"}) {
    const test::RunFolder folder;

    const auto result = folder.run(faulty("unwritten", "step", {where, "--replay"}));

    test::check_failed(folder, result, 1,
                       {"module 'structure' (faulty_structure", "in step, step 7",
                        "structure/wet.work[0, 0] was never written by this call"});
  }
}

TEST_CASE("a window beyond the machine's memory is refused before anything is allocated")
{
  for (const char* where : {"--processes", "--inline"}) {
    const test::RunFolder folder;

    const auto result = folder.run(faulty("huge", "define", {where}));

    test::check_failed(folder, result, 1,
                       {"module 'structure' (faulty_structure", "in define, before the first step",
                        "too little memory for 'structure/spare': it needs 512.1 GiB, ", " are available"});
  }
}

TEST_CASE("a window that its own module overwrote with garbage is refused before anyone believes in it")
{
  for (const char* where : {"--processes", "--inline"}) {
    const test::RunFolder folder;

    const auto result = folder.run(faulty("garbage_window", "define", {where}));

    test::check_failed(folder, result, 1,
                       {"module 'structure' (faulty_structure", "in define",
                        "window structure/wet: its memory object is damaged or foreign: the magic number is "});
  }
}

TEST_CASE("a window that its own module overwrites with garbage later harms nobody else")
{
  for (const auto& place : places) {
    if (place.at == "define") continue;
    CAPTURE(place.at);
    const test::RunFolder folder;

    const auto result = folder.run(faulty("garbage_window", place.at));

    // Who has checked the window goes on with what was checked, or the run ends with the module's name.
    CAPTURE(result.err);
    CHECK((result.exit_code == 0 || result.exit_code == 1));
    if (result.exit_code == 1) test::check_failed(folder, result, 1, {"structure", "faulty_structure"});
    test::check_nothing_left(folder);
  }
}

TEST_CASE("a module that prints two megabytes goes on, and every line arrives with its name")
{
  for (const bool is_process : {true, false}) {
    CAPTURE(is_process);
    const test::RunFolder folder;
    const auto flag = is_process ? "--processes" : "--inline";
    auto silent = test::piston({}, {flag});
    silent.out = "silent";
    REQUIRE(folder.run(silent).exit_code == 0);

    const auto result = folder.run(faulty("print", "step", {flag}));

    REQUIRE(result.exit_code == 0);
    CHECK(test::difference(folder / "out", folder / "silent") == "");
    std::map<std::string, std::set<std::string>> seen;
    for (const auto& stream : {result.err, result.out}) {
      std::istringstream text(stream);
      for (std::string line; std::getline(text, line);)
        for (const std::string kind : {"stdout", "stderr"}) {
          const auto at = line.find(kind + " line ");
          if (at == std::string::npos) continue;
          const bool is_whole = line.ends_with(" of a megabyte, which nobody asked this for...");
          const bool is_named = !is_process || has(line.substr(0, at), " structure: ");
          if (is_whole && is_named) seen[kind].insert(line.substr(at, 17));
        }
    }
    CHECK(seen["stdout"].size() == 16384);
    CHECK(seen["stderr"].size() == 16384);
  }
}

TEST_CASE("a module's log lines carry its name and their level")
{
  for (const char* where : {"--processes", "--inline"}) {
    const test::RunFolder folder;

    const auto result = folder.run(faulty("log", "step", {where}));

    CAPTURE(result.err);
    CHECK(result.exit_code == 0);
    CHECK(has(result.err, " info structure: the first line of step 7\n"));
    CHECK(has(result.err, " info structure: the second line of step 7\n"));
    CHECK(has(result.err, " warning structure: a warning in step 7\n"));
  }
}

TEST_CASE("plug-ins of another ABI or another build are refused before anything runs")
{
  const test::RunFolder folder;

  const auto other_abi = folder.run(test::piston({"fluid.module=wrong_abi"}));
  const auto other_build = folder.run(test::piston({"driver.scheme=wrong_build"}));

  CHECK(other_abi.exit_code == 2);
  CHECK(has(other_abi.err, "wrong_abi.so: built for plug-in ABI 999, this mullion has ABI 2"));
  CHECK(other_build.exit_code == 2);
  CHECK(has(other_build.err, "wrong_build.so: compiled against another build of libmullion"));
  CHECK(!std::filesystem::exists(folder / "out"));
  test::check_nothing_left(folder);
}
