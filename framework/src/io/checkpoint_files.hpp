// The checkpoints of a run's folder: what they are called, which are there, which of them is the newest good one, and
// which are too many.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mullion::io {

struct CheckpointFile {
  std::filesystem::path path;
  std::int64_t step;
};

/// "checkpoint-000000400.h5": nine digits or more, so that names sort as steps do.
[[nodiscard]] std::string checkpoint_name(std::int64_t step);

/// The checkpoints in a folder by their names, newest (latest step) first; none if there is no such folder.
[[nodiscard]] std::vector<CheckpointFile> list_checkpoints(const std::filesystem::path& folder);

/// The newest checkpoint in a folder whose trailer and contents are sound; each is tried in a child process.
/// @param problems  if given: why each newer one is not
[[nodiscard]] std::optional<CheckpointFile> newest_good_checkpoint(const std::filesystem::path& folder,
                                                                   std::vector<std::string>* problems = nullptr);

/// Remove all but the `n` newest up to `step`; 0: none is removed. Never throws.
void keep_newest_checkpoints(const std::filesystem::path& folder, std::int64_t n, std::int64_t step) noexcept;

/// Remove those of later steps than `step`: a run that goes on from there makes its own. Never throws.
void remove_checkpoints_after(const std::filesystem::path& folder, std::int64_t step) noexcept;

} // namespace mullion::io
