#include <mullion/app/live_runs.hpp>

#include "process/ask.hpp"

#include <mullion/sdk/error.hpp>

#include <filesystem>

namespace mullion {
namespace {

using process::ask;
using Json = nlohmann::json;

constexpr std::chrono::seconds as_long_as_it_lives{0};

ChangeOutcome change(const std::string& name, const std::string& what, const Json& arguments)
{
  const auto reply = ask(name, what + " " + arguments.dump(), as_long_as_it_lives);
  return {reply.at("ok"), reply.at("step")};
}

} // namespace

std::vector<LiveRun> list_live_runs()
{
  std::vector<LiveRun> runs;
  for (const auto& name : process::live_runs()) {
    auto& run = runs.emplace_back();
    run.name = name;
    try {
      const auto status = ask(name, "status");
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

void stop_run(const std::string& name) { (void)ask(name, "stop"); }

ChangeOutcome swap_module(const std::string& name, const std::string& target, const std::string& plugin,
                          const std::vector<std::string>& sets)
{
  const bool is_path = plugin.find('/') != std::string::npos; // seen from our folder, not the run's
  const auto module = is_path ? std::filesystem::absolute(plugin).string() : plugin;
  return change(name, "swap", {{"target", target}, {"module", module}, {"sets", sets}});
}

ChangeOutcome set_parameters(const std::string& name, const std::vector<std::string>& sets)
{
  return change(name, "set", {{"sets", sets}});
}

ChangeOutcome request_checkpoint(const std::string& name) { return change(name, "checkpoint", Json::object()); }

} // namespace mullion
