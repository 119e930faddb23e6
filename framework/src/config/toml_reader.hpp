// From TOML text to a document with places; the only doorway to the TOML library.
#pragma once

#include "config/toml_document.hpp"

#include <optional>
#include <string>
#include <vector>

namespace mullion::config {

struct SyntaxError {
  Place place;
  std::string message;
};

/// Parse a whole file's text; the root is a table.
/// @returns the first syntax error, if there is one: what follows it can't be trusted
std::variant<Node, SyntaxError> parse_toml(const std::string& text);

/// Parse the value of a `--set`: a TOML value, or, failing that, the text itself.
Node parse_value(const std::string& text, const Place& place);

/// Can TOML hold this text? (It must be UTF-8.)
bool is_valid_text(const std::string& text);

/// Parse a dotted key ("fluid.cells", quotes as in TOML) into its parts; nothing if it is no key.
std::optional<std::vector<std::string>> parse_key(const std::string& text);

} // namespace mullion::config
