#include "run/recovery.hpp"

#include "log/console.hpp"

#include <mullion/sdk/error.hpp>

namespace mullion::run {

void Recovery::attempt_once(const TimeStep& step)
{
  session_.begin_attempt();
  try {
    session_.run_driver(step);
    session_.check_limits(step);
  } catch (const Error& error) {
    const auto& hint = session_.wiring().divergence_hint;
    if (error.code() != Errc::numeric || hint.empty()) throw;
    throw Error(Errc::numeric, fmt::format("{} ({})", error.what(), hint));
  }
}

void Recovery::attempt(const TimeStep& step)
{
  const auto then = fmt::format("step {} is done again from the last commit", step.index);
  for (;;) {
    try {
      return attempt_once(step);
    } catch (const Error& error) {
      if (commands_.take_back(step, error.what())) continue;
      recover(error, step.index, then);
    }
  }
}

void Recovery::between_steps(const std::function<void()>& action)
{
  for (;;) {
    try {
      return action();
    } catch (const Error& error) {
      recover(error, session_.control().step, "it is asked again");
    }
  }
}

void Recovery::recover(const Error& error, std::int64_t step, const std::string& then)
{
  if (error.code() != Errc::process || session_.the_case().on_failure != "respawn") throw error;
  std::string text = error.what();
  for (;;) { // a host may die while it is started anew
    if (!deaths_.insert(session_.last_death()).second)
      throw Error(Errc::process,
                  fmt::format("{}; the same had happened before in this step, which ends the run", text));
    if (deaths_.size() > most_deaths)
      throw Error(Errc::process,
                  fmt::format("{}; it was death number {} in this step, which ends the run", text, deaths_.size()));
    std::vector<std::string> respawned;
    try {
      respawned = session_.recover();
    } catch (const Error& again) {
      if (again.code() != Errc::process) throw;
      text = again.what();
      continue;
    }
    if (respawned.empty()) throw error;
    for (const auto& instance : respawned) recorder_.note(step, "respawn", instance, text);
    log::warning("run", "{}; respawned '{}', {}", text, fmt::join(respawned, "', '"), then);
    return;
  }
}

} // namespace mullion::run
