// `mullion study STUDY`: a matrix of cases, one table.
#include "commands/arguments.hpp"

#include <mullion/app/study.hpp>

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace mullion::cli {

namespace po = boost::program_options;

int run_study(const Arguments& arguments)
{
  CommandLine command{"mullion study STUDY [options]",
                      "Run a case with varied keys, several runs at a time, and write one table of measures. A study "
                      "that was\nended is gone on with by the same command; finished runs are not repeated.",
                      {},
                      "study"};
  command.options.add_options()("jobs,j", po::value<int>()->value_name("N"),
                                "runs at a time (default: as many as there are cores)")(
      "out", po::value<std::string>()->value_name("DIR"), "folder of the study (default: out/<study name>)")(
      "retry", "do failed and stopped runs again")("log-level", po::value<std::string>()->value_name("LEVEL"),
                                                   "debug, info (default), warning, error or off");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  const auto& values = *given;
  if (values.count("study") == 0) throw UsageError("no study given; expected " + command.usage);

  StudyOptions options;
  options.file = values["study"].as<std::vector<std::string>>().front();
  if (values.count("out") != 0) options.out = values["out"].as<std::string>();
  if (values.count("log-level") != 0) options.log_level = values["log-level"].as<std::string>();
  options.has_retry = values.count("retry") != 0;
  if (values.count("jobs") != 0) {
    options.n_parallel = values["jobs"].as<int>();
    if (options.n_parallel < 1) throw UsageError("-j takes a whole number of runs, 1 or more");
  }
  const auto outcome = mullion::run_study(options);
  if (!outcome.diagnostics.empty()) {
    fmt::print(stderr, "{}", describe(options.file, outcome.diagnostics));
    return wrong_usage;
  }
  fmt::print("{}", outcome.summary);
  return outcome.n_completed == outcome.n_runs && outcome.n_incomplete == 0 ? success : run_failed;
}

} // namespace mullion::cli
