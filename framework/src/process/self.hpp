// Where this executable and its companions lie.
#pragma once

#include <string>

namespace mullion::process {

/// The host program that belongs to this installation or build tree.
/// @throws Error Errc::process with the places that were tried
std::string host_executable();

} // namespace mullion::process
