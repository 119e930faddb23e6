// Start a program that ends when we do: for runs that a study starts. The child gets a process group of its own, so
// that the terminal's signals reach it through us alone, and an empty signal mask.
//
// When this process dies, whatever the reason, the kernel kills the child (PDEATHSIG). Descriptors that are not
// close-on-exec go to the child.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace mullion::process {

/// @param command  the program's path and its arguments
/// @param output   file for its standard output and error, replaced
/// @pre            the calling thread lives as long as the child shall: PDEATHSIG fires when it ends
/// @throws Error Errc::process
pid_t start_child(const std::vector<std::string>& command, const std::string& output);

} // namespace mullion::process
