// Run a study, a matrix of cases, from its file to one table: what `mullion study` does, for the command line and
// bindings.
#pragma once

#include <mullion/app/case_file.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace mullion {

struct StudyOptions {
  std::string file;
  std::string out;        ///< folder of the study; "" is out/<study name>
  int n_parallel = 0;     ///< runs at a time; 0: as many as there are cores
  bool has_retry = false; ///< runs that failed or were stopped are done again
  std::string log_level = "info";
};

struct StudyOutcome {
  std::vector<Diagnostic> diagnostics; ///< not empty: the study file, or a case that it makes, is wrong; nothing ran
  std::size_t n_runs = 0, n_completed = 0, n_failed = 0, n_stopped = 0;
  std::size_t n_incomplete = 0; ///< completed, but a measure could not be taken
  std::string interrupted_by;   ///< the signal that ended the study early; "" without one
  std::string out;              ///< the folder with study.csv
  std::string summary;          ///< the first rows of the table and where the rest is
};

/// Run what is not yet done, each run in a process of its own; then write study.csv, study.h5 and study.json.
/// Messages go to standard error. No process is left behind, however this ends.
/// @throws Error Errc::config: the folder belongs to another study, or a live one is at work in it; Errc::io,
///               Errc::process
[[nodiscard]] StudyOutcome run_study(const StudyOptions& options);

} // namespace mullion
