// `mullion run`: composes the options and leaves the rest to the library.
#include "commands/arguments.hpp"

#include <mullion/app/simulation.hpp>

#include <boost/program_options/value_semantic.hpp>

namespace mullion::cli {

namespace po = boost::program_options;

int run_run(const Arguments& arguments)
{
  CommandLine command{"mullion run [CASE] [options]", "Run a case, or go on with one.", {}, "case"};
  command.options.add_options()("set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
                                "overrule a key of the case, e.g. fluid.cells=200; may be repeated")(
      "out", po::value<std::string>()->value_name("DIR"), "results folder (default: out/<run name>)")(
      "restart", po::value<std::string>()->value_name("FILE|latest"),
      "go on from a checkpoint: a file, or the newest good one of the results folder; without CASE: with the case that "
      "the checkpoint holds")("inline", "every module inline, whatever the case says")(
      "processes", "every module in a process of its own")("replay", "do every step twice and compare the bytes")(
      "amnesia", po::value<int>()->value_name("K"),
      "do every K-th step again with fresh processes and a new driver, and compare the bytes")(
      "no-deadline", "wait for modules for ever (debuggers)")(
      "log-level", po::value<std::string>()->value_name("LEVEL"), "debug, info (default), warning, error or off");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  const auto& values = *given;
  RunOptions options;
  if (values.count("restart") != 0) options.restart = values["restart"].as<std::string>();
  if (values.count("case") != 0) options.case_file = values["case"].as<std::vector<std::string>>().front();
  else if (options.restart.empty()) throw UsageError("no case given; expected " + command.usage);
  if (values.count("set") != 0) options.case_options.overrides = values["set"].as<std::vector<std::string>>();
  if (values.count("out") != 0) options.out = values["out"].as<std::string>();
  if (options.restart == "latest" && options.case_file.empty() && options.out.empty())
    throw UsageError("--restart latest looks in the results folder; give it with --out, or the case");
  if (values.count("log-level") != 0) options.log_level = values["log-level"].as<std::string>();
  options.case_options.all_inline = values.count("inline") != 0;
  options.case_options.all_processes = values.count("processes") != 0;
  if (options.case_options.all_inline && options.case_options.all_processes)
    throw UsageError("--inline and --processes exclude each other");
  options.replay = values.count("replay") != 0;
  options.has_deadlines = values.count("no-deadline") == 0;
  if (values.count("amnesia") != 0) {
    options.amnesia = values["amnesia"].as<int>();
    if (options.amnesia < 1) throw UsageError("--amnesia takes a whole number of steps, 1 or more");
    if (options.case_options.all_inline) throw UsageError("--amnesia needs processes; it excludes --inline");
    options.case_options.all_processes = true; // fresh processes need modules in processes
  }
  return run_case(options);
}

} // namespace mullion::cli
