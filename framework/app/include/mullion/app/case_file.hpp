// A case as it is run: one TOML file plus the --set overrides, read, validated and flattened. Reading collects
// all errors, each with its place, so that a user mends a case in one go.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace mullion {

/// A parameter value in the declared order of its plug-in.
struct ParameterValue {
  std::string name;
  std::variant<double, std::int64_t, bool, std::string> value;
  bool is_given = false; ///< by the case, rather than the plug-in's default
};

struct ModuleCase {
  std::string instance; ///< the table's name: "fluid"
  std::string kind;     ///< from the plug-in: "fluid"
  std::string plugin;   ///< the name of its library
  std::string version;  ///< of the plug-in
  std::string path;     ///< of the library
  bool is_process = false;
  std::vector<ParameterValue> parameters;
};

struct InterfaceCase {
  std::string fluid, structure; ///< "fluid.wall", "structure.wet"
};

/// Where a received field comes from, as the driver declared it: for showing the topology.
struct ConnectionCase {
  std::string receiver; ///< "structure.wet.traction"
  std::string source;   ///< bound: "fluid.wall.traction"; empty: stored, the driver writes it
  std::string policy;   ///< "constant", "linear", "quadratic"
};

/// A value that the run's summary compares with a measured one: [[expect]] in the case.
struct Expectation {
  std::string quantity;   ///< a column of history.csv
  double amplitude = 0.0; ///< 0: not given; half of max - min over the run
  double frequency = 0.0; ///< [Hz] 0: not given; the dominant frequency
  std::string source;     ///< where the numbers come from
};

/// A number that a module is asked for at the end of the run: [output] functions.
struct FunctionCall {
  std::string instance, function;
  std::vector<double> arguments;
  std::string text; ///< as the case has it: "structure.frequency(1)"
};

struct Case {
  std::string file;
  std::string name;
  double start_time = 0.0, end_time = 0.0, dt = 0.0;    ///< [s]
  double call_deadline = 300.0, start_deadline = 600.0; ///< [s]; 0: none
  std::string on_failure = "stop";
  std::string on_divergence = "stop";
  std::int64_t max_halvings = 6;   ///< of a step, with on_divergence = "halve_dt"
  std::vector<ModuleCase> modules; ///< in the order fluid, structure, mesh_motion, transfer, then by name
  std::vector<InterfaceCase> interfaces;
  double reference_pressure = 0.0;
  double displacement_limit = 0.0; ///< [m] of the wet surface; 0: none
  std::string scheme;              ///< the driver's plug-in
  std::string scheme_path;         ///< of the library
  std::vector<ParameterValue> driver_parameters;
  std::vector<ConnectionCase> connections;
  std::int64_t output_every = 0; ///< steps between result files; 0: none
  bool has_history = true;
  std::int64_t history_every = 1;    ///< steps between its rows
  std::int64_t checkpoint_every = 0; ///< steps between checkpoints; 0: none but that of a run that ends early
  std::int64_t keep_checkpoints = 2; ///< so many stay; 0: all
  std::vector<Expectation> expectations;
  std::vector<FunctionCall> functions;
  std::string text; ///< the case as it is run, overrides included: what case.toml will say
};

/// One mistake in a case, with its place.
struct Diagnostic {
  std::string place; ///< "piston.toml:12:3" or "--set fluid.cells=x"
  std::string message;
};

struct CaseOptions {
  std::vector<std::string> overrides; ///< "fluid.cells=100", as --set got them
  bool all_inline = false, all_processes = false;
};

/// Read and validate. `diagnostics` empty: the case can be run.
struct CaseResult {
  Case value;
  std::vector<Diagnostic> diagnostics;
};
CaseResult read_case(const std::string& file, const CaseOptions& options);
/// The same of a text. @param file what messages call it
CaseResult read_case_text(const std::string& text, const std::string& file, const CaseOptions& options);

/// One line per mistake, "place: error: message", and a last line that counts them.
std::string describe(const std::string& file, const std::vector<Diagnostic>& diagnostics);

} // namespace mullion
