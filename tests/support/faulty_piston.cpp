#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

#include <sstream>

namespace mullion::test {

CaseRun piston(const std::vector<std::string>& sets, const std::vector<std::string>& flags)
{
  return {.file = MULLION_SOURCE_DIR "/tests/process/faulty_piston.toml", .sets = sets, .flags = flags};
}

CaseRun long_piston(const std::vector<std::string>& sets, const std::vector<std::string>& flags)
{
  auto run = piston(sets, flags);
  run.sets.insert(run.sets.begin(), {"run.end_time=0.12188988004400882", "output.every=1000"});
  return run;
}

void run_whole(const RunFolder& folder, const std::vector<std::string>& sets)
{
  auto run = long_piston(sets, {"--inline"});
  run.out = "whole";
  run.sets.emplace_back("run.name=whole");
  REQUIRE(folder.run(run).exit_code == 0);
  REQUIRE(last_step(folder / "whole") == 20000);
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::vector<std::string> error_messages(const ProcessResult& result)
{
  const std::string mark = "mullion: error: ";
  std::vector<std::string> messages;
  std::istringstream text(result.err);
  for (std::string line; std::getline(text, line);)
    if (line.rfind(mark, 0) == 0) messages.push_back(line.substr(mark.size()));
  return messages;
}

void check_failed(const RunFolder& folder, const ProcessResult& result, int exit_code,
                  const std::vector<std::string>& parts)
{
  CAPTURE(result.err);
  CHECK(!result.has_timed_out);
  CHECK(result.exit_code == exit_code);
  const auto messages = error_messages(result);
  REQUIRE(messages.size() == 1);
  for (const auto& part : parts) CHECK_MESSAGE(has(messages[0], part), part);
  const auto record = read_record(folder / "out");
  CHECK(record.at("outcome") != "running");
  CHECK(record.at("outcome") != "completed");
  CHECK(record.at("attempts").at(0).at("error") == messages[0]);
  for (const auto& timing : record.at("attempts").at(0).at("timings")) { // a record that was written in good order
    CHECK(timing.at("count").get<long long>() >= 0);
    CHECK(timing.at("count").get<long long>() <= 2 * 20001);
  }
  check_nothing_left(folder);
}

void check_nothing_left(const RunFolder& folder)
{
  CHECK(folder.is_deserted_within(std::chrono::seconds(1)));
  CHECK(folder.new_shared_memory().empty());
}

pid_t find_orchestrator(const RunFolder& folder, pid_t guard)
{
  pid_t found = 0;
  (void)wait_until([&] {
    for (const auto& process : folder.processes())
      if (!process.is_host() && process.parent == guard) found = process.pid;
    return found != 0;
  });
  return found;
}

pid_t find_host(const RunFolder& folder, int module)
{
  pid_t found = 0;
  (void)wait_until([&] {
    for (const auto& process : folder.processes())
      if (process.is_host() && process.module() == module) found = process.pid;
    return found != 0;
  });
  return found;
}

} // namespace mullion::test
