// Bytes from base64 text, as VTK's XML files carry them.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace mullion::mesh_files {

/// The bytes of a text of base64 without blanks, up to its first padding; nothing if it is no base64.
std::optional<std::string> from_base64(std::string_view text);

} // namespace mullion::mesh_files
