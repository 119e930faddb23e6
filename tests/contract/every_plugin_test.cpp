// Every installed module and driver, in at least one case, gives the same bytes however it is run: inline, in
// processes, with every step done twice, by processes that know nothing but their windows, and twice at the same time.
//
// A new plug-in needs a line in `cases`; this test says so.
#include "support/run_case.hpp"

#include <mullion/app/catalogue.hpp>

#include <doctest/doctest.h>

#include <set>
#include <string>
#include <vector>

using namespace mullion;

namespace {

/// A short case: 40 steps or so, with result files.
struct PluginCase {
  std::string file; ///< in the source tree
  std::vector<std::string> sets;
};

const std::string piston_steps = "run.end_time=2.4377976008801763e-4"; // 40 steps
const std::vector<PluginCase> cases = {
    {"configs/closed_piston.toml", {piston_steps, "output.every=10", "fluid.cells=20"}},
    {"configs/closed_piston.toml",
     {piston_steps, "output.every=10", "fluid.cells=20", "fluid.limiter=van_albada", "fluid.substeps=3",
      "structure.integrator=central_difference", "structure.substeps=2", "driver.alpha=0.25", "driver.beta=0.5",
      "driver.profile=linear"}},
    {"configs/closed_piston.toml",
     {"run.end_time=2.4e-4", "output.every=15", "fluid.cells=20", "fluid.left_end=open", "fluid.substeps=2",
      "structure.far_end=free", "driver.order=fluid_first", "driver.beta=0.25"}}, // the last step is a shorter one
};

test::CaseRun to_run(const PluginCase& c, const std::vector<std::string>& flags, const std::string& out)
{
  return {.file = MULLION_SOURCE_DIR "/" + c.file, .sets = c.sets, .flags = flags, .out = out};
}

} // namespace

TEST_CASE("every installed module and driver runs in a case of this test")
{
  const test::RunFolder folder;
  std::set<std::string> used;
  for (const auto& c : cases) {
    REQUIRE(folder.run(to_run(c, {"--inline"}, "out")).exit_code == 0);
    const auto attempt = test::read_record(folder / "out").at("attempts").at(0);
    used.insert(attempt.at("driver").get<std::string>());
    for (const auto& module : attempt.at("modules")) used.insert(module.at("module").get<std::string>());
  }

  const auto installed = list_plugins();

  CHECK(installed.size() >= 5);
  for (const auto& plugin : installed) {
    CHECK_MESSAGE(plugin.problem == "", plugin.name);
    CHECK_MESSAGE(used.contains(plugin.name), "no case of tests/contract/every_plugin_test.cpp runs the plug-in ",
                  plugin.name);
  }
}

TEST_CASE("every plug-in gives the same bytes inline, in processes, replayed, amnesiac and twice at the same time")
{
  for (const auto& c : cases) {
    const test::RunFolder folder;
    CAPTURE(&c - cases.data());
    REQUIRE(folder.run(to_run(c, {"--inline"}, "reference")).exit_code == 0);
    CHECK(test::last_step(folder / "reference") == 40);

    const std::vector<std::vector<std::string>> ways = {
        {"--processes"}, {"--inline", "--replay"}, {"--processes", "--replay"}, {"--amnesia", "1"}, {"--amnesia", "7"}};
    for (const auto& flags : ways) {
      CAPTURE(flags[0]);
      CAPTURE(flags.back());
      const auto result = folder.run(to_run(c, flags, "out"));
      CHECK_MESSAGE(result.exit_code == 0, result.err);
      CHECK(test::difference(folder / "out", folder / "reference") == "");
    }

    auto one = to_run(c, {"--processes"}, "one"), other = to_run(c, {"--processes"}, "other");
    one.sets.emplace_back("run.name=one");
    other.sets.emplace_back("run.name=other");
    const auto first = folder.start(one), second = folder.start(other);
    CHECK(first->wait().exit_code == 0);
    CHECK(second->wait().exit_code == 0);
    CHECK(test::difference(folder / "one", folder / "reference") == "");
    CHECK(test::difference(folder / "other", folder / "reference") == "");

    CHECK(folder.is_deserted_within(std::chrono::seconds(1)));
    CHECK(folder.new_shared_memory().empty());
  }
}
