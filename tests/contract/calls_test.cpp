// Calls as a driver makes them: both solvers at the same time, functions by name, and every misuse refused.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

namespace {

CaseRun calls_run(const std::string& what, const std::string& flag)
{
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/cli/good_case.toml";
  run.sets = {"driver.scheme=calls_driver", "driver.what=" + what};
  run.flags = {flag};
  return run;
}

} // namespace

TEST_CASE("two solvers at the same time over stored fields give the same bytes inline, in processes, replayed, amnesiac")
{
  const RunFolder folder;
  auto run = calls_run("parallel", "--inline");
  run.out = "inline";
  REQUIRE(folder.run(run).exit_code == 0);

  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"--processes"}, {"--replay"}, {"--amnesia", "7"}, {"--processes", "--replay"}}) {
    CAPTURE(flags.front());
    run.flags = flags;
    run.out = "other";
    const auto result = folder.run(run);
    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    CHECK(difference(folder / "other", folder / "inline") == "");
  }
}

TEST_CASE("a function is found by name, called, and answers, in a host as inline")
{
  for (const char* flag : {"--inline", "--processes"}) {
    const RunFolder folder;

    const auto result = folder.run(calls_run("query", flag));

    CHECK_MESSAGE(result.exit_code == 0, result.err);
  }
}

TEST_CASE("misuse by a driver is refused with the reason")
{
  struct Misuse {
    const char *what, *message;
    int exit_code;
  };
  for (const auto& [what, message, exit_code] :
       {Misuse{"parallel_in_place", "a call of 'structure' was started while 'fluid' is at work, but one reads the other's "
                                    "window in place",
               2},
        Misuse{"twice", "module 'fluid' was called again before it was awaited", 2},
        Misuse{"unknown_function", "module 'structure' (trivial_structure) offers no function 'energie'", 2},
        Misuse{"wrong_signature", "function 'scaled' of module 'structure' takes 1 numbers and answers 1; the driver expects 3 "
                                  "and 1",
               2},
        Misuse{"no_put", "the driver has not written fluid/wall.in.velocity in this step", 1},
        Misuse{"not_finite", "wrote nan into fluid/wall.in.velocity[0, 0]", 1}})
    for (const char* flag : {"--inline", "--processes"}) {
      CAPTURE(what);
      CAPTURE(flag);
      const RunFolder folder;

      const auto result = folder.run(calls_run(what, flag));

      CHECK(result.exit_code == exit_code);
      CHECK_MESSAGE(result.err.find(message) != std::string::npos, result.err);
      CHECK(folder.is_deserted_within(std::chrono::seconds(1)));
    }
}
