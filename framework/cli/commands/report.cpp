// `mullion report DIR`: the plots of a run or a study on one page.
#include "commands/arguments.hpp"

#include <mullion/app/report.hpp>

#include <fmt/format.h>

namespace mullion::cli {

int run_report(const Arguments& arguments)
{
  const CommandLine command{
      "mullion report DIR",
      "Plot a run or a study: one HTML file that opens without a network, DIR/report/report.html,\n"
      "and its plots as SVG and PNG in DIR/report/plots/. DIR is the results folder.",
      {},
      "folder"};
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("folder") == 0) throw UsageError("no folder given; expected " + command.usage);
  const auto report = write_report((*given)["folder"].as<std::vector<std::string>>().front());
  fmt::print("{} ({} plot{})\n", report.file, report.n_plots, report.n_plots == 1 ? "" : "s");
  return success;
}

} // namespace mullion::cli
