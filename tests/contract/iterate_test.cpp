// Sub-iterations: a module that is stepped again within a coupling step starts from the last committed level.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

TEST_CASE("stepping every module three times, twice with wrong input, gives the bytes of stepping it once")
{
  const RunFolder folder;
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/configs/closed_piston.toml";
  run.sets = {"run.end_time=0.0004", "output.every=20", "driver.profile=linear", "expect=[]"};
  run.flags = {"--inline"};
  run.out = "once";
  const auto once = folder.run(run);
  REQUIRE_MESSAGE(once.exit_code == 0, once.err);
  run.sets = {"run.end_time=0.0004", "output.every=20", "driver.scheme=css_iterated", "expect=[]"};

  for (const std::vector<std::string>& flags :
       {std::vector<std::string>{"--inline"}, {"--processes"}, {"--replay"}, {"--amnesia", "9"}}) {
    CAPTURE(flags.front());
    run.flags = flags;
    run.out = "iterated";
    const auto iterated = folder.run(run);
    REQUIRE_MESSAGE(iterated.exit_code == 0, iterated.err);
    CHECK(difference(folder / "iterated", folder / "once") == "");
  }
}
