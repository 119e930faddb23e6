// A case's text as it stands after a live run was changed: what a checkpoint keeps, and what a restart reads.
#pragma once

#include <mullion/app/case_file.hpp>

#include <string>
#include <vector>

namespace mullion::config {

/// Give a table of the case another plug-in or other parameters: [structure] module, or [driver] scheme. Keys of
/// parameters that are not given go; how the table is placed (process) stays.
/// @param name_key  "module" or "scheme"
/// @pre `text` is a case that was read before
std::string edit_plugin(const std::string& text, const std::string& table, const std::string& name_key,
                        const std::string& plugin, const std::vector<ParameterValue>& parameters);

/// Set one key of a table, which is made if need be.
std::string edit_key(const std::string& text, const std::string& table, const ParameterValue& value);

} // namespace mullion::config
