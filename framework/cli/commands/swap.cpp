// `mullion swap RUN KIND=MODULE`: other code for a module of a live run.
#include "commands/arguments.hpp"

#include <mullion/app/live_runs.hpp>

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>

namespace mullion::cli {

namespace po = boost::program_options;

int run_swap(const Arguments& arguments)
{
  CommandLine command{
      "mullion swap RUN KIND=MODULE [--set KEY=VALUE]…",
      "Swap a module in a live run at a step boundary, in a process at the first after it has attached. KIND is\n"
      "a kind or an instance, MODULE the name of a plug-in, or the path of a library (with a '/'). Waits until\n"
      "the first step with it is committed; if that step fails, the one before takes over and does it again.",
      {},
      "run",
      2};
  command.options.add_options()(
      "set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
      "a parameter of the module that leaves its windows and first states as they are; may be repeated");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  const auto words = given->count("run") == 0 ? Arguments{} : (*given)["run"].as<Arguments>();
  if (words.size() < 2) throw UsageError("expected " + command.usage);
  const auto equals = words[1].find('=');
  if (equals == std::string::npos || equals == 0 || equals + 1 == words[1].size())
    throw UsageError(fmt::format("'{}' is no KIND=MODULE", words[1]));
  const auto sets = given->count("set") == 0 ? Arguments{} : (*given)["set"].as<Arguments>();
  const auto outcome = swap_module(words[0], words[1].substr(0, equals), words[1].substr(equals + 1), sets);
  fmt::print("{}; at work from step {} on\n", outcome.text, outcome.step);
  return success;
}

} // namespace mullion::cli
