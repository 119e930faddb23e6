// read_case(): text, overrides, then table after table; [run], [output] and [[expect]] are read here.
#include <mullion/app/case_file.hpp>

#include "config/case_reader.hpp"
#include "config/function_calls.hpp"
#include "config/overrides.hpp"
#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"
#include "run/time_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <tuple>

namespace mullion::config {
namespace {

constexpr std::uintmax_t max_case_bytes = 16u << 20; ///< a larger file is no case somebody wrote

struct RunOptions {
  std::string name, on_failure = "stop", on_divergence = "stop";
  std::int64_t max_halvings = 6;
  double start_time = 0.0, end_time = 0.0, dt = 0.0, call_deadline = 300.0, start_deadline = 600.0;
  static constexpr auto table()
  {
    return std::tuple{required_parameter("name", &RunOptions::name, "", "name of the run"),
                      parameter("on_failure", &RunOptions::on_failure, "",
                                "what follows the death of a module's process", one_of("stop", "respawn")),
                      parameter("on_divergence", &RunOptions::on_divergence, "",
                                "what follows a step in which values left their legal range",
                                one_of("stop", "halve_dt")),
                      parameter("max_halvings", &RunOptions::max_halvings, "1",
                                "halve_dt: how often a step is halved at most", between(1.0, 30.0)),
                      parameter("start_time", &RunOptions::start_time, "s", "begin of the run"),
                      required_parameter("end_time", &RunOptions::end_time, "s", "end of the run"),
                      required_parameter("dt", &RunOptions::dt, "s", "coupling step", above(0.0)),
                      parameter("call_deadline", &RunOptions::call_deadline, "s",
                                "longest time of one call of a module, 0: no limit", at_least(0.0)),
                      parameter("start_deadline", &RunOptions::start_deadline, "s",
                                "longest time of a module's start, 0: no limit", at_least(0.0))};
  }
};

struct OutputOptions {
  std::int64_t every = 0;
  bool history = true;
  std::int64_t history_every = 1;
  std::int64_t checkpoint_every = 0, keep_checkpoints = 2;
  std::string functions;
  static constexpr auto table()
  {
    return std::tuple{
        parameter("every", &OutputOptions::every, "1", "steps between two result files, 0: none", at_least(0.0)),
        parameter("history", &OutputOptions::history, "", "write history.csv"),
        parameter("history_every", &OutputOptions::history_every, "1", "steps from one row of history.csv to the next",
                  at_least(1)),
        parameter("checkpoint_every", &OutputOptions::checkpoint_every, "1", "steps between two checkpoints, 0: none",
                  at_least(0.0)),
        parameter("keep_checkpoints", &OutputOptions::keep_checkpoints, "1",
                  "so many checkpoints stay, the newest ones, 0: all", at_least(0.0)),
        parameter("functions", &OutputOptions::functions, "",
                  "numbers that modules are asked for at the end, \"structure.frequency(1); …\"")};
  }
};

struct ExpectOptions {
  std::string quantity, source;
  double amplitude = 0.0, frequency = 0.0;
  static constexpr auto table()
  {
    return std::tuple{required_parameter("quantity", &ExpectOptions::quantity, "", "a column of history.csv"),
                      required_parameter("source", &ExpectOptions::source, "", "where the numbers come from"),
                      parameter("amplitude", &ExpectOptions::amplitude, "",
                                "half of maximum minus minimum, in the quantity's unit", above(0.0)),
                      parameter("frequency", &ExpectOptions::frequency, "Hz", "dominant frequency", above(0.0))};
  }
};

/// A table read into its options; the given flags are in `values`.
template <class Options>
Options read_options(const Node& node, const std::string& label, Diagnostics& diagnostics,
                     std::vector<ParameterValue>& values)
{
  values = read_parameters(node, {label, ""}, detail::parameter_specs<Options>(), {}, diagnostics);
  return detail::read_options<Options>(to_values(values).data());
}

bool is_given(const std::vector<ParameterValue>& values, std::string_view name)
{
  return std::any_of(values.begin(), values.end(), [&](const auto& v) { return v.name == name && v.is_given; });
}

/// A name becomes a folder and part of a socket's path.
bool is_run_name(const std::string& name)
{
  const auto is_legal = [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '.' || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= 64 && std::all_of(name.begin(), name.end(), is_legal) &&
         name.find_first_not_of('.') != std::string::npos;
}

/// @returns are start, end and step such that steps can be counted?
bool check_times(const Case& value, const Table& table, const std::vector<ParameterValue>& given,
                 Diagnostics& diagnostics)
{
  if (!is_given(given, "end_time")) return false;
  const auto wrong = [&](const char* key, const std::string& message) {
    diagnostics.add(table.find(key)->value.place, message);
    return false;
  };
  if (!(value.start_time < value.end_time))
    return wrong("end_time", fmt::format("[run] end_time = {} is not behind start_time = {}; expected a later time",
                                         write_real(value.end_time), write_real(value.start_time)));
  if (!is_given(given, "dt")) return false;
  const double latest = std::max(std::abs(value.start_time), std::abs(value.end_time));
  if (!(latest - value.dt < latest))
    return wrong("dt", fmt::format("[run] dt = {} is lost beside the time {}: adding it changes nothing in double "
                                   "precision; take longer steps",
                                   write_real(value.dt), write_real(latest)));
  try {
    static_cast<void>(run::TimePlan(value, false));
  } catch (const Error& error) {
    return wrong("dt", error.what());
  }
  return true;
}

/// @returns are the times sound?
bool read_run(CaseReader& reader)
{
  Case& value = reader.value;
  const Node* node = reader.table("run");
  if (node == nullptr) {
    if (reader.root.table()->find("run") == nullptr)
      reader.diagnostics.add({}, "there is no [run]; add the table with name, end_time and dt");
    return false;
  }
  std::vector<ParameterValue> given;
  const auto run = read_options<RunOptions>(*node, "[run]", reader.diagnostics, given);
  value.name = run.name;
  value.start_time = run.start_time;
  value.end_time = run.end_time;
  value.dt = run.dt;
  value.call_deadline = run.call_deadline;
  value.start_deadline = run.start_deadline;
  value.on_failure = run.on_failure;
  value.on_divergence = run.on_divergence;
  value.max_halvings = run.max_halvings;
  const Table& table = *node->table();
  if (is_given(given, "name") && !is_run_name(run.name)) {
    const Node& name = table.find("name")->value;
    reader.diagnostics.add(name.place, fmt::format("[run] name = {} is no run name; expected 1 to 64 letters, digits, "
                                                   "'.', '_' or '-', and not dots alone",
                                                   write_value(name)));
  }
  return check_times(value, table, given, reader.diagnostics);
}

/// A dead module can be replaced only if its memory did not die with it.
void check_respawn(CaseReader& reader)
{
  if (reader.value.on_failure != "respawn") return;
  std::vector<std::string> inline_ones;
  for (const auto& module : reader.value.modules)
    if (!module.is_process) inline_ones.push_back("[" + module.instance + "]");
  if (inline_ones.empty()) return;
  reader.diagnostics.add(
      reader.table("run")->table()->find("on_failure")->value.place,
      fmt::format("[run] on_failure = \"respawn\" needs every module in a process of its own, and {} "
                  "{} inline{}",
                  fmt::join(inline_ones, ", "), inline_ones.size() == 1 ? "is" : "are",
                  reader.options.all_inline ? " by --inline; leave that flag out"
                                            : "; write process = true there, or give --processes"));
}

/// Is there such a function of so many numbers? What is not right is reported.
bool is_function(CaseReader& reader, const FunctionCall& call, const Place& place)
{
  const auto complain = [&](const std::string& what) {
    reader.diagnostics.add(place, fmt::format("[output] functions: {}: {}", call.text, what));
    return false;
  };
  const auto* instance = reader.module(call.instance);
  if (instance == nullptr) return complain(fmt::format("the case has no module '{}'", call.instance));
  const auto& module = reader.catalogue.open(instance->plugin).module();
  std::vector<std::string> known;
  for (const auto& spec : std::span(module.functions, module.n_functions)) {
    if (spec.n_results == 0) continue; // an action of the step
    known.emplace_back(spec.name);
    if (call.function != spec.name) continue;
    if (call.arguments.size() == spec.n_arguments) return true;
    return complain(fmt::format("{} takes {} number{}, not {}: {}", call.function, spec.n_arguments,
                                spec.n_arguments == 1 ? "" : "s", call.arguments.size(), spec.meaning));
  }
  return complain(fmt::format("{} offers no '{}'{}", instance->plugin, call.function,
                              known.empty() ? ": it answers nothing" : suggestion(call.function, known)));
}

void read_functions(CaseReader& reader, const std::string& text, const Node& output, bool are_modules_known)
{
  const auto found = parse_function_calls(text);
  const auto* entry = output.table()->find("functions");
  if (!found.complaint.empty())
    return reader.diagnostics.add(entry->value.place, "[output] functions: " + found.complaint);
  for (const auto& call : found.calls)
    if (are_modules_known && is_function(reader, call, entry->value.place)) reader.value.functions.push_back(call);
}

void read_output(CaseReader& reader, bool are_modules_known)
{
  const Node* node = reader.table("output");
  if (node == nullptr) return;
  std::vector<ParameterValue> given;
  const auto output = read_options<OutputOptions>(*node, "[output]", reader.diagnostics, given);
  reader.value.output_every = output.every;
  reader.value.has_history = output.history;
  reader.value.history_every = output.history_every;
  reader.value.checkpoint_every = output.checkpoint_every;
  reader.value.keep_checkpoints = output.keep_checkpoints;
  read_functions(reader, output.functions, *node, are_modules_known);
}

void read_expectations(CaseReader& reader)
{
  const auto* entry = reader.root.table()->find("expect");
  if (entry == nullptr) return;
  const List* list = entry->value.list();
  const bool are_tables = list != nullptr && std::all_of(list->begin(), list->end(), [](const Node& element) {
                            return element.table() != nullptr;
                          });
  if (!are_tables) {
    reader.diagnostics.add(entry->place, "'expect' is no list of tables; write [[expect]] for each expected number");
    return;
  }
  for (const auto& node : *list) {
    std::vector<ParameterValue> given;
    const auto expect = read_options<ExpectOptions>(node, "[[expect]]", reader.diagnostics, given);
    if (node.table()->find("amplitude") == nullptr && node.table()->find("frequency") == nullptr)
      reader.diagnostics.add(node.place, "[[expect]] gives neither 'amplitude' nor 'frequency'; expected at least one "
                                         "number to compare with");
    reader.value.expectations.push_back({expect.quantity, expect.amplitude, expect.frequency, expect.source});
  }
}

/// The document as it is run: --inline and --processes are overrides too.
void overrule_process_keys(Node& root, const Case& value)
{
  for (const auto& module : value.modules) {
    Table& table = *root.table()->find(module.instance)->value.table();
    if (Entry* entry = table.find("process")) entry->value.value = module.is_process;
    else if (module.is_process) table.entries.push_back({"process", {}, {{}, true}});
  }
}

/// @returns "" and the text, or what is wrong
std::string read_file(const std::string& file, std::string& text)
{
  std::error_code error;
  if (std::filesystem::is_directory(file, error)) return "is a folder; expected a case file in TOML";
  std::ifstream in(file, std::ios::binary);
  if (!in) return fmt::format("cannot be read: {}", std::strerror(errno));
  if (const auto bytes = std::filesystem::file_size(file, error); !error && bytes > max_case_bytes)
    return fmt::format("has {} bytes; a case file has at most {}", bytes, max_case_bytes);
  text.assign(std::istreambuf_iterator<char>(in), {});
  return in.bad() ? fmt::format("cannot be read: {}", std::strerror(errno)) : "";
}

void read_tables(CaseReader& reader)
{
  const bool are_times_sound = read_run(reader);
  const bool are_modules_known = read_modules(reader);
  const bool is_interface_sound = read_coupling(reader, are_modules_known);
  const bool is_driver_sound = read_driver(reader);
  check_respawn(reader);
  read_output(reader, are_modules_known);
  read_expectations(reader);
  if (are_modules_known && is_interface_sound && is_driver_sound) check_scheme(reader, are_times_sound);
}

} // namespace

const Node* CaseReader::table(const std::string& name) const
{
  const auto* entry = root.table()->find(name);
  if (entry == nullptr) return nullptr;
  return entry->value.table() == nullptr ? nullptr : &entry->value;
}

const ModuleCase* CaseReader::module(std::string_view instance) const
{
  const auto found = std::find_if(value.modules.begin(), value.modules.end(),
                                  [&](const ModuleCase& m) { return m.instance == instance; });
  return found == value.modules.end() ? nullptr : &*found;
}

} // namespace mullion::config

namespace mullion {

CaseResult read_case(const std::string& file, const CaseOptions& options)
{
  std::string text;
  if (const auto problem = config::read_file(file, text); !problem.empty()) {
    CaseResult result;
    result.value.file = file;
    result.diagnostics.push_back({file, problem});
    return result;
  }
  return read_case_text(text, file, options);
}

CaseResult read_case_text(const std::string& text, const std::string& file, const CaseOptions& options)
{
  using namespace config;
  CaseResult result;
  result.value.file = file;
  if (options.all_inline && options.all_processes) {
    result.diagnostics.push_back({"--inline --processes", "the two flags contradict each other; give one"});
    return result;
  }
  Diagnostics diagnostics;
  auto parsed = parse_toml(text);
  if (const auto* error = std::get_if<SyntaxError>(&parsed)) {
    diagnostics.add(error->place, error->message);
    result.diagnostics = diagnostics.sorted(file);
    return result;
  }
  Node& root = std::get<Node>(parsed);
  apply_overrides(root, options.overrides, diagnostics);
  for (const auto& name : framework_tables) // what stands in a table's place; [[expect]] is a list
    if (const auto* entry = root.table()->find(name);
        entry != nullptr && name != "expect" && entry->value.table() == nullptr)
      diagnostics.add(entry->place, fmt::format("'{0}' is no table here; write [{0}], once", name));

  plugin::Catalogue catalogue;
  CaseReader reader{root, options, catalogue, diagnostics, result.value};
  read_tables(reader);
  if (options.all_inline || options.all_processes) overrule_process_keys(root, result.value);
  result.value.text = write_toml(root);
  result.diagnostics = diagnostics.sorted(file);
  return result;
}

std::string describe(const std::string& file, const std::vector<Diagnostic>& diagnostics)
{
  std::string text;
  for (const auto& diagnostic : diagnostics)
    text += fmt::format("{}: error: {}\n", diagnostic.place, diagnostic.message);
  return text + fmt::format("mullion: error: {} has {} mistake{}\n", file, diagnostics.size(),
                            diagnostics.size() == 1 ? "" : "s");
}

} // namespace mullion
