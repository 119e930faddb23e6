// What plug-ins there are and what each declares, as plain texts: for `mullion modules`, tests and bindings.
#pragma once

#include <string>
#include <vector>

namespace mullion {

struct PluginSummary {
  std::string name, kind, version, summary, path;
  std::string problem; ///< why the library was refused; "" if it can be used
};

struct ParameterRow {
  std::string name, type; ///< type: "real", "integer", "boolean", "text"
  std::string unit;       ///< "1" for plain numbers, "" for texts and booleans
  std::string fallback;   ///< the default as TOML writes it; "required" if there is none
  std::string range;      ///< "> 0", "in [0, 1]", "a | b"; "" without limits
  std::string meaning;    ///< ends in "; changeable" if `mullion set` may change it in a live run
};

struct FieldRow {
  std::string name; ///< window.field
  std::string unit;
  std::string location;   ///< "node", "element", "pane"
  std::string components; ///< "vector", "1", "2", …
  std::string role;       ///< "state", "output", "fixed"; of a received field "required", "optional"
  std::string nature;     ///< "intensive", "extensive"
  std::string meaning;
};

struct FunctionRow {
  std::string name, signature, meaning; ///< signature: "writes wall" or "(2 numbers) -> number"
};

struct PluginReference {
  PluginSummary summary;
  std::vector<ParameterRow> parameters;
  std::vector<FieldRow> fields, inputs;
  std::vector<FunctionRow> functions;
};

/// Every library on the plug-in path, those that were refused included; by kind, then by name.
std::vector<PluginSummary> list_plugins();

/// The folders that list_plugins() looks into.
std::vector<std::string> plugin_folders();

/// All that one plug-in declares.
/// @throws Error Errc::plugin: unknown or refused
PluginReference describe_plugin(const std::string& name);

/// "; did you mean 'x'?", or "; known are a, b, c" without a near name.
std::string did_you_mean(const std::string& given, const std::vector<std::string>& known);

} // namespace mullion
