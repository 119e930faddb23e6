// Declared parameters against one table of the case: types, ranges, choices, required and unknown keys. The
// framework's own tables ([run], [output], …) are declared in the same way as a plug-in's parameters.
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"

#include <mullion/app/case_file.hpp>
#include <mullion/sdk/abi.h>

#include <span>
#include <string>
#include <vector>

namespace mullion::config {

/// Who wants the keys of a table, as messages name it.
struct TableOwner {
  std::string label; ///< "[fluid]"
  std::string name;  ///< "trivial_fluid"; empty for the framework's own tables
};

/// The values of all declared parameters, in the order of the declaration; a wrong or missing value is reported
/// and stands at its default.
/// @param other_keys  legal keys that somebody else reads
/// @pre `node` is a table
std::vector<ParameterValue> read_parameters(const Node& node, const TableOwner& owner,
                                            std::span<const mullion_parameter_spec> specs,
                                            const std::vector<std::string>& other_keys, Diagnostics& diagnostics);

/// Take one value for one parameter.
/// @returns "" or what is wrong: `= 0 is out of range; expected an integer >= 1: number of nodes`
std::string take_value(const Node& node, const mullion_parameter_spec& spec, ParameterValue& out);

/// The default as a value, not given.
ParameterValue default_value(const mullion_parameter_spec& spec);

/// What a parameter wants, in words: "a number > 0 [s]", "true or false", "\"stop\" or \"respawn\"".
std::string expected(const mullion_parameter_spec& spec);

/// Its interval or choices: "> 0", "in [0, 1]", "stop | respawn"; "" if there is no limit.
std::string range_text(const mullion_parameter_spec& spec);

/// The flat values that cross the plug-in boundary; texts point into `parameters`.
std::vector<mullion_value> to_values(const std::vector<ParameterValue>& parameters);

} // namespace mullion::config
