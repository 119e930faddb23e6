// `mullion checkpoint RUN`: a checkpoint of a live run.
#include "commands/arguments.hpp"

#include <mullion/app/live_runs.hpp>

#include <fmt/format.h>

namespace mullion::cli {

int run_checkpoint(const Arguments& arguments)
{
  const CommandLine command{"mullion checkpoint RUN",
                            "Ask a live run for a checkpoint at its next step boundary, and wait until it is written.",
                            {},
                            "run"};
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("run") == 0) throw UsageError("no run given; 'mullion ps' lists the live ones");
  const auto outcome = request_checkpoint((*given)["run"].as<Arguments>().front());
  fmt::print("{}\n", outcome.text);
  return success;
}

} // namespace mullion::cli
