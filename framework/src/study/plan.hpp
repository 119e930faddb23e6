// The runs that a study file makes, each checked by the case reader before any of them starts, and each with a
// fingerprint of all that its results depend on.
#pragma once

#include "study/study_file.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace mullion::study {

struct PlannedRun {
  std::string name;                   ///< of the live run: <study>.<index>
  std::vector<std::string> overrides; ///< as --set takes them, the name included
  std::string fingerprint;            ///< of the case as it is run, this program and the plug-ins
};

struct Plan {
  std::vector<PlannedRun> runs;
  std::vector<Diagnostic> diagnostics; ///< of the first run whose case is wrong
};

[[nodiscard]] Plan make_plan(const StudyFile& study);

/// The flag of `mullion run` for the study's placement; "": as the case says.
[[nodiscard]] std::string placement_flag(const StudyFile& study);

/// Does the measure look into history.csv?
[[nodiscard]] bool needs_history(const std::string& kind);

} // namespace mullion::study
