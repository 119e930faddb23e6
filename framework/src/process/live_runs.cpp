#include <mullion/app/live_runs.hpp>

#include "process/run_socket.hpp"

#include <mullion/sdk/error.hpp>

#include <nlohmann/json.hpp>

namespace mullion {

std::vector<LiveRun> list_live_runs()
{
  std::vector<LiveRun> runs;
  for (const auto& name : process::live_runs()) {
    auto& run = runs.emplace_back();
    run.name = name;
    try {
      const auto status = nlohmann::json::parse(process::ask_run(name, "status"));
      run.pid = status.at("pid");
      run.step = status.at("step");
      run.n_steps = status.at("steps");
      run.time = status.at("time");
    } catch (const std::exception& error) {
      run.problem = error.what();
    }
  }
  return runs;
}

void stop_run(const std::string& name)
{
  const auto answer = process::ask_run(name, "stop");
  MULLION_REQUIRE(answer == "ok", Errc::process, "run '{}' answered: {}", name, answer);
}

} // namespace mullion
