// "State lives in windows", and the two flags that enforce it: plug-ins that keep state elsewhere run to the end
// without them, and are caught and named with them.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion;

namespace {

constexpr const char* rule_case = MULLION_SOURCE_DIR "/tests/contract/rule.toml";
constexpr const char* one_point = "structure.nodes=1"; // trivial_structure; the bad ones have one point anyway

struct Audited {
  const char* how;
  std::vector<std::string> flags;
};
const std::vector<Audited> replays = {{"the same instances (--replay)", {"--replay", "--inline"}},
                                      {"the same instances (--replay)", {"--replay", "--processes"}}};
const Audited amnesia = {"fresh processes and a new driver (--amnesia)", {"--amnesia", "1"}};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string message_of(const test::ProcessResult& result)
{
  const auto at = result.err.find("mullion: error: ");
  return at == std::string::npos ? "" : result.err.substr(at);
}

/// A structure that breaks the rule; which of the two flags can see it.
struct Offender {
  std::string plugin;
  bool is_seen_by_replay, is_seen_by_amnesia;
  std::vector<std::string> sets;
};

const std::vector<Offender> offenders = {
    {"bad_member", true, true, {}},
    {"bad_file_static", true, true, {}},
    {"bad_template_static", false, true, {}}, // it remembers the first load: twice the same, but not in a fresh process
    {"bad_disk", true, true, {"structure.path=counter.txt"}},
    {"bad_cached_time", true, true, {}},
    {"bad_cached_operator", false, true, {}}, // an operator assembled at an earlier time
};

/// @param what  how the audit names the place: window.field[component, entity] and the plug-in
void check_verdict(const test::ProcessResult& result, const Audited& audited, bool is_seen, const std::string& place,
                   const std::string& culprit)
{
  CAPTURE(audited.flags[0]);
  CAPTURE(audited.flags.back());
  CAPTURE(result.err);
  if (!is_seen) {
    CHECK(result.exit_code == 0);
    return;
  }
  CHECK(result.exit_code == 1);
  CHECK(has(message_of(result),
            std::string("done again by ") + audited.how + " differs: " + place + " (component, entity) was "));
  CHECK(has(message_of(result), culprit + " keeps state outside its windows"));
}

} // namespace

TEST_CASE("modules that keep state outside their windows run to the end when nobody looks")
{
  for (const auto& offender : offenders)
    for (const char* where : {"--inline", "--processes"}) {
      CAPTURE(offender.plugin);
      CAPTURE(where);
      const test::RunFolder folder;
      auto sets = offender.sets;
      sets.push_back("structure.module=" + offender.plugin);

      const auto result = folder.run({.file = rule_case, .sets = sets, .flags = {where}});

      CHECK(result.exit_code == 0);
      CHECK(test::last_step(folder / "out") == 6);
    }
}

TEST_CASE("a module that keeps state outside its windows is caught and named")
{
  for (const auto& offender : offenders) {
    CAPTURE(offender.plugin);
    REQUIRE((offender.is_seen_by_replay || offender.is_seen_by_amnesia));
    auto sets = offender.sets;
    sets.push_back("structure.module=" + offender.plugin);
    const auto audit = [&](const Audited& audited, bool is_seen) {
      const test::RunFolder folder;
      const auto result = folder.run({.file = rule_case, .sets = sets, .flags = audited.flags});
      check_verdict(result, audited, is_seen, "structure/wet.velocity[1, 0]",
                    "module 'structure' (" + offender.plugin + ")");
      if (is_seen) CHECK(test::read_record(folder / "out").at("outcome") == "failed");
    };

    for (const auto& replay : replays) audit(replay, offender.is_seen_by_replay);
    audit(amnesia, offender.is_seen_by_amnesia);
  }
}

TEST_CASE("a driver that keeps state in a member runs when nobody looks, and is caught and named")
{
  const auto run = [](const std::vector<std::string>& flags) {
    const test::RunFolder folder;
    return folder.run({.file = rule_case, .sets = {"driver.scheme=bad_driver", one_point}, .flags = flags});
  };
  const std::string place = "structure/wet.in.traction[1, 0]", culprit = "driver bad_driver";

  CHECK(run({"--inline"}).exit_code == 0);
  CHECK(run({"--processes"}).exit_code == 0);
  for (const auto& replay : replays) check_verdict(run(replay.flags), replay, true, place, culprit);
  check_verdict(run(amnesia.flags), amnesia, true, place, culprit);
}

TEST_CASE("plug-ins that keep to the rule pass both checks")
{
  for (const auto& flags : std::vector<std::vector<std::string>>{
           {"--replay", "--inline"}, {"--replay", "--processes"}, {"--amnesia", "1"}, {"--amnesia", "4", "--replay"}}) {
    const test::RunFolder folder;
    CHECK(folder.run({.file = rule_case, .sets = {one_point}, .flags = flags}).exit_code == 0);
  }
}

TEST_CASE("a fixed field that a module writes after all is caught by --replay")
{
  const test::RunFolder folder;
  const test::CaseRun run = {.file = MULLION_SOURCE_DIR "/tests/process/faulty_piston.toml",
                             .sets = {"structure.fault=stray_write_fixed", "structure.at_step=3"},
                             .flags = {"--inline"}};
  auto replayed = run;
  replayed.flags = {"--inline", "--replay"};

  CHECK(folder.run(run).exit_code == 0);
  const auto result = folder.run(replayed);
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  CHECK(has(message_of(result),
            "step 3 done again by the same instances (--replay) differs: structure/spare.bulk[3, 0]"));
  CHECK(has(message_of(result), "module 'structure' (faulty_structure)"));
}
