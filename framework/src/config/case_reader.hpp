// The parts of read_case(), a file per table: each reads its tables into the case and reports every mistake; the
// return values say whether what a later part builds on is sound, so that one mistake is reported once.
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"
#include "plugin/catalogue.hpp"

#include <mullion/app/case_file.hpp>
#include <mullion/sdk/parameters.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::config {

/// What a case may have besides its modules.
inline const std::vector<std::string> framework_tables = {"run", "coupling", "driver", "output", "expect"};

/// The one module parameter that [coupling] gives, to every module that declares it.
inline constexpr std::string_view reference_pressure = "reference_pressure";

struct CaseReader {
  const Node& root;
  const CaseOptions& options;
  plugin::Catalogue& catalogue;
  Diagnostics& diagnostics;
  Case& value;

  /// The table of this name; a value or list in its place is reported.
  [[nodiscard]] const Node* table(const std::string& name) const;
  [[nodiscard]] const ModuleCase* module(std::string_view instance) const;
};

/// Every table that is not the framework's: a module instance. @returns are all plug-ins known, and of one kind each
bool read_modules(CaseReader& reader);

/// [coupling]: the interface pair, and the reference pressure for whoever declares one.
/// @returns is the interface sound?
bool read_coupling(CaseReader& reader, bool are_modules_known);

/// [driver]: the scheme and its parameters. @returns are both sound?
bool read_driver(CaseReader& reader);

/// What the scheme connects, asked from the driver itself and checked. @pre the three above returned true
void check_scheme(CaseReader& reader, bool are_times_sound);

/// The plug-in of this name, or nothing and a diagnostic at `place`.
const plugin::Library* open_plugin(CaseReader& reader, const std::string& name, const Place& place,
                                   const std::string& label);

} // namespace mullion::config
