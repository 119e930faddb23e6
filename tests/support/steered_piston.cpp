#include "support/steered_piston.hpp"

#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

#include <csignal>

namespace mullion::test {
namespace {

CaseRun longer_piston(const std::vector<std::string>& flags, const std::vector<std::string>& sets = {})
{
  std::vector<std::string> all{"run.end_time=1.8283482006601323", "output.every=15000", "output.history_every=10"};
  all.insert(all.end(), sets.begin(), sets.end());
  return piston(all, flags);
}

} // namespace

std::unique_ptr<Process> live_piston(const RunFolder& folder, const std::vector<std::string>& flags,
                                     const std::vector<std::string>& sets)
{
  std::filesystem::remove_all(folder / "out");
  auto run = folder.start(longer_piston(flags, sets));
  REQUIRE(folder.wait_for_step(piston_name, 5));
  return run;
}

std::filesystem::path whole_piston()
{
  static const RunFolder folder;
  static const bool is_made = [] {
    auto run = longer_piston({"--inline"}, {"run.name=whole"});
    run.out = "whole";
    return folder.run(run).exit_code == 0;
  }();
  REQUIRE(is_made);
  return folder / "whole";
}

void check_undisturbed(const RunFolder& folder, Process& run)
{
  run.send(SIGINT);
  const auto result = run.wait();
  CHECK_MESSAGE(result.exit_code == 0, result.err);
  CHECK(last_step(folder / "out") > 0);
  CHECK(difference_of_part(folder / "out", whole_piston()) == "");
  check_nothing_left(folder);
}

std::vector<std::string> events(const RunFolder& folder)
{
  std::vector<std::string> found;
  const auto record = read_record(folder / "out"); // must outlive the loop over it
  for (const auto& event : record.at("attempts").at(0).at("events"))
    found.push_back(event.at("what").get<std::string>() + " " + event.at("instance").get<std::string>());
  return found;
}

} // namespace mullion::test
