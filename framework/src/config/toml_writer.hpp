// From a document back to TOML text, in the document's order. Numbers are written shortest such that they read
// back to the same bits: the library's own writer prints 0.05 as 0.050000000000000003.
#pragma once

#include "config/toml_document.hpp"

#include <string>

namespace mullion::config {

/// @pre `root` is a table
std::string write_toml(const Node& root);

/// One value as TOML writes it: 0.05, "text", [1, 2].
std::string write_value(const Node& node);

/// A value as a message names it: `"many" is a text`, `3 is an integer`, `[1, 2] is a list`.
std::string describe(const Node& node);

/// A real number as TOML: shortest digits that read back to the same double, never without '.' or exponent.
std::string write_real(double value);

} // namespace mullion::config
