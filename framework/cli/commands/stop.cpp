// `mullion stop RUN`: end a live run cleanly.
#include "commands/arguments.hpp"

#include <mullion/app/live_runs.hpp>

#include <fmt/format.h>

namespace mullion::cli {

int run_stop(const Arguments& arguments)
{
  const CommandLine command{"mullion stop RUN", "End a live run cleanly at its next step boundary.", {}, "run"};
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("run") == 0) throw UsageError("no run given; 'mullion ps' lists the live ones");
  const auto name = (*given)["run"].as<std::vector<std::string>>().front();
  stop_run(name);
  fmt::print("run '{}' ends after the step at hand\n", name);
  return success;
}

} // namespace mullion::cli
