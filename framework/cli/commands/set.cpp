// `mullion set RUN KEY=VALUE`: parameters of a live run.
#include "commands/arguments.hpp"

#include <mullion/app/live_runs.hpp>

#include <fmt/format.h>

namespace mullion::cli {

int run_set(const Arguments& arguments)
{
  const CommandLine command{
      "mullion set RUN KEY=VALUE…",
      "Change parameters of a live run at its next step boundary: those of a module (structure.substeps=2) or of the\n"
      "driver (driver.kappa=0.3) that 'mullion modules NAME' calls changeable, run.end_time and output.every. Keys of\n"
      "one table at a time. Waits until the first step with them is committed.",
      {},
      "run",
      -1};
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  auto words = given->count("run") == 0 ? Arguments{} : (*given)["run"].as<Arguments>();
  if (words.size() < 2) throw UsageError("expected " + command.usage);
  const auto name = words.front();
  words.erase(words.begin());
  const auto outcome = set_parameters(name, words);
  fmt::print("{}\n", outcome.text);
  return success;
}

} // namespace mullion::cli
