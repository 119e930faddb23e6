// Schemes that promise to run both solvers at the same time do so: fluid and structure wait for one another within
// their steps. No clock is compared; a scheme that takes one after the other cannot pass, however fast the machine.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

ProcessResult meeting(const RunFolder& folder, const std::vector<std::string>& driver, const std::string& patience)
{
  const auto place = folder / "meeting";
  std::filesystem::create_directories(place);
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/contract/meeting.toml";
  for (const std::string module : {"fluid", "structure"}) {
    run.sets.push_back(module + ".folder=" + place.string());
    run.sets.push_back(module + ".patience=" + patience);
  }
  for (const auto& option : driver) run.sets.push_back("driver." + option);
  return folder.run(run);
}

} // namespace

TEST_CASE("css_parallel and strong with iteration = parallel have both solvers at work at the same time")
{
  for (const std::vector<std::string>& driver :
       {std::vector<std::string>{"scheme=css_parallel"}, {"scheme=strong", "iteration=parallel"}}) {
    CAPTURE(driver.front());
    const RunFolder folder;

    const auto result = meeting(folder, driver, "10");

    CHECK_MESSAGE(result.exit_code == 0, result.err);
    CHECK(std::filesystem::exists(folder / "meeting/fluid.3.0"));
  }
}

TEST_CASE("schemes that take one solver after the other never have both at work")
{
  for (const std::vector<std::string>& driver :
       {std::vector<std::string>{"scheme=css"}, {"scheme=strong", "iteration=serial"}}) {
    CAPTURE(driver.front());
    const RunFolder folder;

    const auto result = meeting(folder, driver, "0.2"); // in vain, however long

    CHECK(result.exit_code == 1);
    CHECK_MESSAGE(result.err.find("did not come") != std::string::npos, result.err);
  }
}
