// Files that are wrong on purpose, and what a command must say of them: the whole of standard error, word for word.
// Each says at its top what is expected:
//
//   # arguments: --set fluid.nodes=0       more arguments, if any
//   # expect 12:3: message                 a diagnostic at line 12, column 3 of this file
//   # expect --set fluid.nodes=0: error: message     a diagnostic of another place: the whole line
//
// {plugins} and {install} stand for the plug-in folders of tests and build, {build} for the build id.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace mullion::test {

/// Run `mullion COMMAND FILE` on every .toml of a folder: each is refused with all of its mistakes, exit code 2.
/// @param least  so many files there are at least: a folder that was not found proves nothing
void check_broken_files(const std::filesystem::path& folder, const std::string& command, std::size_t least);

} // namespace mullion::test
