// `mullion mesh CASE`: look at the meshes of a case before it is run.
#include "commands/arguments.hpp"

#include <mullion/app/meshes.hpp>

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>

#include <cstdio>

namespace mullion::cli {

namespace po = boost::program_options;

int run_mesh(const Arguments& arguments)
{
  CommandLine command{
      "mullion mesh CASE [options]",
      "Have the modules make their windows, do no step, and write the meshes: all windows with their\n"
      "first state for ParaView (results.xdmf), INSTANCE.msh for Gmsh with the boundaries' names, from\n"
      "modules that know them, and a summary (meshes.txt), which is printed too.",
      {},
      "case"};
  command.options.add_options()("set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
                                "overrule a key of the case, e.g. fluid.mesh=box:40x20; may be repeated")(
      "out", po::value<std::string>()->value_name("DIR"), "folder (default: out/<run name>-mesh)");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("case") == 0) throw UsageError("no case given; expected " + command.usage);

  MeshOptions options;
  options.case_file = (*given)["case"].as<std::vector<std::string>>().front();
  if (given->count("set") != 0) options.case_options.overrides = (*given)["set"].as<std::vector<std::string>>();
  if (given->count("out") != 0) options.out = (*given)["out"].as<std::string>();
  const auto outcome = write_meshes(options);
  if (!outcome.diagnostics.empty()) {
    fmt::print(stderr, "{}", describe(options.case_file, outcome.diagnostics));
    return wrong_usage;
  }
  fmt::print("{}", outcome.summary);
  return outcome.exit_code;
}

} // namespace mullion::cli
