// `mullion ps`: the live runs of this user.
#include "commands/arguments.hpp"

#include <mullion/app/live_runs.hpp>

#include <fmt/format.h>

namespace mullion::cli {

int run_ps(const Arguments& arguments)
{
  const CommandLine command{"mullion ps", "List the live runs of this user.", {}, ""};
  if (!parse_arguments(command, arguments)) return success;
  const auto runs = list_live_runs();
  if (runs.empty()) {
    fmt::print("no live runs\n");
    return success;
  }
  fmt::print("{:<24} {:>8} {:>22} {:>14}\n", "run", "pid", "step", "time [s]");
  for (const auto& run : runs) {
    if (!run.problem.empty()) fmt::print("{:<24} {}\n", run.name, run.problem);
    else
      fmt::print("{:<24} {:>8} {:>22} {:>14.6g}\n", run.name, run.pid, fmt::format("{}/{}", run.step, run.n_steps),
                 run.time);
  }
  return success;
}

} // namespace mullion::cli
