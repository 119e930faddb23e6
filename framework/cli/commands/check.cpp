// `mullion check CASE`: everything that can be known without running, and the topology on one screen.
#include "commands/arguments.hpp"

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace mullion::cli {
namespace {

namespace po = boost::program_options;

std::size_t widest(const std::vector<std::string>& texts)
{
  std::size_t width = 0;
  for (const auto& text : texts) width = std::max(width, text.size());
  return width;
}

/// Rows under a heading that stands in front of the first one.
class Section {
public:
  explicit Section(const char* heading) : heading_(heading) {}
  template <class... T> void row(fmt::format_string<T...> text, T&&... values)
  {
    fmt::print("{:<12} {}\n", heading_, fmt::format(text, std::forward<T>(values)...));
    heading_ = "";
  }

private:
  const char* heading_;
};

void print_topology(const Case& value)
{
  const double steps = std::ceil((value.end_time - value.start_time) / value.dt - 1e-9); // less is round-off
  Section("run").row("{}: {} s to {} s in {:.0f} steps of {} s; on failure: {}", value.name, value.start_time,
                     value.end_time, steps, value.dt, value.on_failure);

  std::vector<std::string> instances, names, sources;
  for (const auto& module : value.modules) {
    instances.push_back(module.instance);
    names.push_back(module.plugin);
  }
  Section modules("modules");
  for (const auto& module : value.modules)
    modules.row("{:<{}}  {:<11}  {:<{}}  {}", module.instance, widest(instances), module.kind, module.plugin,
                widest(names), module.is_process ? "process" : "inline");
  Section("driver").row("{}", value.scheme);
  for (const auto& pair : value.interfaces)
    Section("interface").row("{} | {}, reference pressure {} Pa", pair.fluid, pair.structure, value.reference_pressure);

  for (const auto& connection : value.connections)
    sources.push_back(connection.source.empty() ? "(driver)" : connection.source);
  Section connections("connections");
  for (std::size_t i = 0; i < sources.size(); ++i)
    connections.row("{:<{}} -> {}  ({}, {})", sources[i], widest(sources), value.connections[i].receiver,
                    value.connections[i].source.empty() ? "stored" : "bound", value.connections[i].policy);
  Section("output").row("{}{}",
                        value.output_every == 0 ? "no result files"
                                                : fmt::format("a result file every {} steps", value.output_every),
                        value.has_history ? ", history.csv" : ", no history");
}

} // namespace

int run_check(const Arguments& arguments)
{
  CommandLine command{
      "mullion check CASE [options]", "Validate a case without running it; show who feeds whom.", {}, "case"};
  command.options.add_options()("set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
                                "overrule a key of the case, e.g. fluid.cells=200; may be repeated")(
      "inline", "every module inline, whatever the case says")("processes", "every module in a process of its own");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("case") == 0) throw UsageError("no case given; expected " + command.usage);

  const auto file = (*given)["case"].as<std::vector<std::string>>()[0];
  CaseOptions options;
  if (given->count("set") != 0) options.overrides = (*given)["set"].as<std::vector<std::string>>();
  options.all_inline = given->count("inline") != 0;
  options.all_processes = given->count("processes") != 0;
  const auto result = read_case(file, options);
  if (!result.diagnostics.empty()) {
    fmt::print(stderr, "{}", describe(file, result.diagnostics));
    return wrong_usage;
  }
  fmt::print("{}: ok\n\n", file);
  print_topology(result.value);
  return success;
}

} // namespace mullion::cli
