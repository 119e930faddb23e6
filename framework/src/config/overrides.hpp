// `--set a.b=v`: put one value into the document, making tables and keys where they are missing. Whether the key
// is known is the case reader's question, as for keys from the file.
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"

#include <string>
#include <vector>

namespace mullion::config {

/// Overrides as --set got them, in their order: a later one wins. The place of "fluid.cells=100" in messages is
/// "--set fluid.cells=100".
void apply_overrides(Node& root, const std::vector<std::string>& overrides, Diagnostics& diagnostics);

} // namespace mullion::config
