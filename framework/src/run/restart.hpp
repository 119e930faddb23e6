// How a run begins: with a case alone, or from a checkpoint, with a case that says the same physics or with the one
// that the checkpoint holds.
#pragma once

#include "io/checkpoint.hpp"

#include <mullion/app/simulation.hpp>

#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace mullion::run {

/// What a restarted run goes on from.
struct Restart {
  std::filesystem::path file;
  io::Checkpoint checkpoint;
  std::set<std::string> changed; ///< modules with other parameters than then, as --set asked
};

struct Begin {
  CaseResult the_case; ///< if it has diagnostics, nothing else counts
  std::filesystem::path out;
  std::optional<Restart> restart;
};

/// Read the case and, with --restart, the checkpoint.
/// @throws Error Errc::config: no such checkpoint, a damaged one (with the reason, and the newest good one), or one of
///               other physics (with the keys that differ)
[[nodiscard]] Begin begin_of(const RunOptions& options);

} // namespace mullion::run
