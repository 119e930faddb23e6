// Errors of Mullion: a code that decides the exit status and a text that says where, what was found, what was
// expected and what to do. Exceptions never cross a plug-in boundary; plugin.hpp turns them into status + text.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace mullion {

/// What kind of thing went wrong. Values are the mullion_status numbers of abi.h, hence fixed.
enum class Errc : int {
  config = 1,  ///< the case file, the command line or a parameter is wrong
  plugin = 2,  ///< a plug-in is missing, foreign or of another ABI or build
  shape = 3,   ///< arrays, meshes or windows do not fit together
  numeric = 4, ///< values left their legal range: NaN, negative density, inverted cell
  memory = 5,  ///< too little memory, or a damaged shared-memory object
  process = 6, ///< a process died, hung or could not be started
  io = 7,      ///< a file or socket could not be read or written
  internal = 8 ///< a promise inside Mullion or a plug-in was broken
};

class Error : public std::runtime_error {
public:
  Error(Errc code, const std::string& text) : std::runtime_error(text), code_(code) {}
  [[nodiscard]] Errc code() const { return code_; }

private:
  Errc code_;
};

} // namespace mullion

/// Throw mullion::Error unless `condition` holds: for mistakes of the user, a file, the machine, another process.
#define MULLION_REQUIRE(condition, code, ...)                                                                          \
  do {                                                                                                                 \
    if (!(condition)) throw ::mullion::Error((code), ::fmt::format(__VA_ARGS__));                                      \
  } while (false)

/// A broken invariant of our own: thrown as Errc::internal, so that a run ends with a message and not a core.
#define MULLION_ASSERT(condition, ...)                                                                                 \
  do {                                                                                                                 \
    if (!(condition))                                                                                                  \
      throw ::mullion::Error(::mullion::Errc::internal,                                                                \
                             ::fmt::format("{}:{}: broken invariant '{}': ", __FILE__, __LINE__, #condition) +         \
                                 ::fmt::format(__VA_ARGS__));                                                          \
  } while (false)
