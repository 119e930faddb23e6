// Whose folder it is: a study works in its own, alone, with names of runs that nobody else's live runs have. All three
// are asked before anything runs.
//
// The lock is a file that is open in every process of the study, runs included, so it is free only when the last of
// them is gone: a study that is started right after another was killed waits for the remains of that one.
#pragma once

#include "shm/memory_object.hpp"
#include "study/study_file.hpp"

#include <filesystem>

namespace mullion::study {

/// @return        the locked file, which children inherit
/// @throws Error  Errc::config: another study is at work there; Errc::io
[[nodiscard]] shm::Descriptor lock_folder(const std::filesystem::path& folder);

/// @throws Error  Errc::config: the folder is a run's, or has runs of another study: with what differs
void check_folder(const std::filesystem::path& folder, const StudyFile& study);

/// Names of live runs are unique per user: one of the same name would make ours fail.
/// @throws Error  Errc::config, naming it
void check_names(const StudyFile& study);

} // namespace mullion::study
