// `mullion`: finds the subcommand, turns what it throws into one message on standard error, and alone picks the
// exit code: 0 ok, 1 the run failed, 2 the command line or the case is wrong.
#include "commands/command.hpp"

#include <mullion/app/catalogue.hpp>
#include <mullion/coupling/build_id.hpp>
#include <mullion/sdk/abi.h>
#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace {

using namespace mullion;

struct Command {
  const char* name;
  const char* arguments;
  const char* summary;
  int (*run)(const cli::Arguments&);
};

constexpr Command commands[] = {
    {"run", "CASE [options]", "run a case", &cli::run_run},
    {"check", "CASE [options]", "validate a case without running it", &cli::run_check},
    {"study", "STUDY [options]", "run a matrix of cases, to one table", &cli::run_study},
    {"mesh", "CASE [options]", "write the meshes of a case without running it", &cli::run_mesh},
    {"transfer-test", "[options]", "how well a transfer does between two meshes", &cli::run_transfer_test},
    {"modules", "[NAME]", "list modules and drivers, or the parameters and fields of one", &cli::run_modules},
    {"report", "DIR", "plots of a run or a study on one page", &cli::run_report},
    {"ps", "", "list the live runs", &cli::run_ps},
    {"inspect", "RUN [WINDOW[.FIELD]]", "a live run's windows, fields, values, timings", &cli::run_inspect},
    {"set", "RUN KEY=VALUE…", "change parameters of a live run", &cli::run_set},
    {"swap", "RUN KIND=MODULE", "swap a module in a live run at the next step", &cli::run_swap},
    {"checkpoint", "RUN", "have a live run write a checkpoint", &cli::run_checkpoint},
    {"stop", "RUN", "end a live run cleanly at the next step", &cli::run_stop},
};

void print_help()
{
  fmt::print("usage: mullion COMMAND [arguments]\n\n"
             "Partitioned fluid-structure co-simulation on shared memory.\n\ncommands:\n");
  for (const auto& command : commands)
    fmt::print("  {:<28} {}\n", fmt::format("{} {}", command.name, command.arguments), command.summary);
  fmt::print("\n  mullion COMMAND --help   all about one command\n"
             "  mullion --version        version, plug-in ABI and build id\n\n"
             "exit codes: 0 ok, 1 the run failed, 2 the command line or the case is wrong\n");
}

int fail(const std::string& message, int code)
{
  std::fflush(stdout);
  fmt::print(stderr, "mullion: error: {}\n", message);
  return code;
}

int dispatch(const std::string& name, const cli::Arguments& arguments)
{
  const auto command =
      std::find_if(std::begin(commands), std::end(commands), [&](const Command& c) { return name == c.name; });
  if (command == std::end(commands)) {
    std::vector<std::string> known;
    for (const auto& c : commands) known.emplace_back(c.name);
    const bool is_option = name.starts_with('-');
    return fail(is_option
                    ? fmt::format("unknown option '{}'; options stand behind the command (see mullion --help)", name)
                    : fmt::format("unknown command '{}'{} (see mullion --help)", name, did_you_mean(name, known)),
                cli::wrong_usage);
  }
  try {
    return command->run(arguments);
  } catch (const cli::UsageError& error) {
    return fail(fmt::format("{}: {} (see mullion {} --help)", name, error.what(), name), cli::wrong_usage);
  } catch (const Error& error) {
    const bool is_input_wrong = error.code() == Errc::config || error.code() == Errc::plugin;
    return fail(error.what(), is_input_wrong ? cli::wrong_usage : cli::run_failed);
  } catch (const std::exception& error) {
    return fail(error.what(), cli::run_failed);
  }
}

} // namespace

int main(int argc, char** argv)
{
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  if (arguments.empty() || arguments[0] == "--help" || arguments[0] == "-h") {
    print_help();
    return cli::success;
  }
  if (arguments[0] == "--version") {
    fmt::print("mullion {} (plug-in ABI {}, build {})\n", MULLION_VERSION, MULLION_ABI, MULLION_BUILD_ID);
    return cli::success;
  }
  return dispatch(arguments[0], {arguments.begin() + 1, arguments.end()});
}
