// `mullion transfer-test`: carry a traction from one mesh to another and a motion back, and say how well that went,
// before anything is coupled. It runs a case that is shipped as a file (share/mullion/transfer_test.toml) with some
// keys set: what it does, any user can do with a case of his own.
#include "commands/arguments.hpp"

#include <mullion/app/results.hpp>
#include <mullion/app/simulation.hpp>

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace mullion::cli {
namespace {

namespace po = boost::program_options;
namespace fs = std::filesystem;

std::string shipped_case()
{
  return (fs::read_symlink("/proc/self/exe").parent_path().parent_path() / "share/mullion/transfer_test.toml").string();
}

std::string quoted(const std::string& text)
{
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + "\"";
}

void print_row(const char* what, double value, const std::string& unit)
{
  if (!std::isnan(value)) fmt::print("  {:<44} {:>14.6g} {}\n", what, value, unit);
}

/// Both sides of a quantity that a transfer should keep, and by how much it is off, as a part of its largest component.
void print_pair(const Results& results, const std::string& what, const std::string& fluid, const std::string& structure)
{
  struct Pair {
    std::string name;
    double here, there;
  };
  std::vector<Pair> pairs;
  double largest = 0.0;
  for (const auto& quantity : results.quantities) {
    if (quantity.name.rfind(fluid, 0) != 0) continue;
    const auto suffix = quantity.name.substr(fluid.size()); // "", "_x", …
    const double there = results.value(structure + suffix);
    if ((!suffix.empty() && suffix[0] != '_') || std::isnan(there)) continue;
    pairs.push_back({what + suffix, quantity.value, there});
    largest = std::max({largest, std::abs(quantity.value), std::abs(there)});
  }
  for (const auto& [name, here, there] : pairs)
    fmt::print("  {:<16} {:>16.9g} {:>16.9g} {:>12.2e}\n", name, here, there,
               largest > 0.0 ? std::abs(there - here) / largest : 0.0);
}

void print_table(const Results& results, const std::string& out)
{
  const std::string side = "transfer.structure_side.";
  fmt::print("errors\n");
  print_row("traction on the structure, L2, relative", results.value("structure.wet.load_error_l2"), "");
  print_row("traction on the structure, largest, relative", results.value("structure.wet.load_error_max"), "");
  print_row("motion on the fluid, L2, relative", results.value("fluid.wall.motion_error_l2"), "");
  print_row("motion on the fluid, largest, relative", results.value("fluid.wall.motion_error_max"), "");
  fmt::print("what is kept        fluid's side   structure's side    relative difference\n");
  print_pair(results, "force", side + "fluid_force", side + "force");
  print_pair(results, "moment", side + "fluid_moment", side + "moment");
  print_pair(results, "power", side + "fluid_power", side + "power");
  print_pair(results, "area", side + "fluid_area", side + "area");
  fmt::print("fit\n");
  print_row("least coverage of a fluid face", results.value(side + "least_coverage"), "");
  print_row("covered fraction of the fluid's surface", results.value(side + "covered_fraction"), "");
  print_row("largest gap", results.value(side + "largest_gap"), "m");
  print_row("nodes without a counterpart", results.value(side + "unmatched_nodes"), "");
  fmt::print("time\n");
  for (const auto& call : results.calls) {
    if (call.who != "transfer" || call.count == 0) continue;
    const auto what = call.call == "attach" ? std::string("build the operators") : "one transfer of " + call.call;
    print_row(what.c_str(), 1e3 * call.work_s / static_cast<double>(call.count), "ms");
  }
  print_row("peak memory", results.peak_megabytes, "MB");
  fmt::print("both fields for ParaView: {}/results.xdmf\n", out);
}

} // namespace

int run_transfer_test(const Arguments& arguments)
{
  CommandLine command{
      "mullion transfer-test [CASE] [options]",
      "Carry a traction between two interface meshes and a motion back, and say how well that went.\n"
      "MESH is a file (Gmsh .msh, VTK .vtk, .vtu) or a generated one, say \"rectangle:32x24,triangles\".",
      {},
      "case"};
  const auto text = [] { return po::value<std::string>(); };
  command.options.add_options()("source", text()->value_name("MESH"), "the fluid's side of the interface")(
      "target", text()->value_name("MESH"), "the structure's side")("method", text()->value_name("NAME"),
                                                                    "transfer plug-in (default: that of the case)")(
      "traction", text()->value_name("EXPR"),
      "function of x, y, z that the fluid exports [Pa]; ';' between components")(
      "motion", text()->value_name("EXPR"), "velocity of the structure [m/s], in the same way")(
      "set", po::value<std::vector<std::string>>()->value_name("KEY=VALUE"),
      "any key of the case; may be given several times")("out", text()->value_name("DIR"),
                                                         "results folder (default: out/transfer-test)");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  const auto& values = *given;

  RunOptions options;
  options.case_file =
      values.count("case") == 0 ? shipped_case() : values["case"].as<std::vector<std::string>>().front();
  options.out = values.count("out") == 0 ? "out/transfer-test" : values["out"].as<std::string>();
  options.log_level = "warning";
  options.has_summary = false;
  auto& sets = options.case_options.overrides;
  const auto set = [&](const char* option, std::initializer_list<const char*> keys) {
    if (values.count(option) == 0) return;
    for (const char* key : keys) sets.push_back(fmt::format("{}={}", key, quoted(values[option].as<std::string>())));
  };
  set("source", {"fluid.mesh"});
  set("target", {"structure.mesh"});
  set("method", {"transfer.module"});
  set("traction", {"fluid.function", "structure.expected_traction"});
  set("motion", {"structure.function", "fluid.expected_motion"});
  if (values.count("set") != 0)
    for (const auto& one : values["set"].as<std::vector<std::string>>()) sets.push_back(one);

  const int outcome = run_case(options);
  if (outcome != success) return outcome;
  print_table(read_results(options.out), options.out);
  return success;
}

} // namespace mullion::cli
