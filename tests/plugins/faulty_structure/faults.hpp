// What a bad plug-in can do to the process that carries it, one function each. None of them knows windows.
#pragma once

#include <string>

namespace mullion::test {

/// Throw something that is no std::exception.
[[noreturn]] void throw_foreign();
/// Write to an address that nobody has.
void segfault();
/// Never come back, without using the processor.
[[noreturn]] void hang();
/// Take this long [s] of being run: a time in which the process is stopped does not count.
void dawdle(double seconds);
/// 16384 numbered lines of 64 bytes to each of standard output and standard error: a megabyte each.
void print_two_megabytes();

/// The start of the mapping that holds this address, or of the one whose name contains a text; null: there is none.
char* mapping_of(const void* address);
char* mapping_named(const std::string& part);

} // namespace mullion::test
