// What became of one run of a study: collected from its folder when its process has ended, and kept there in
// done.json. That file is written last and in one step, so a run without it was not finished; whoever died between,
// a later study does that run again.
#pragma once

#include "study/measures.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace mullion::study {

struct RunResult {
  std::string fingerprint; ///< of the run (study/plan.hpp)
  std::string outcome;     ///< "completed", "failed", "stopped"
  std::string message;     ///< one line: why it failed
  bool has_died = false;   ///< the process went without closing its files: they may lack their last lines
  std::int64_t steps = 0;
  double wall_s = 0.0;
  std::vector<std::pair<std::string, double>> functions; ///< asked for at the end, and the answers
  std::string history;                       ///< checksum of history.csv; "": there is none, or nobody needs it
  std::string definition;                    ///< checksum of the measures
  std::vector<std::optional<double>> values; ///< for each column of the measures; empty: not measured
  std::vector<std::string> problems;         ///< measures that could not be taken, a line each
};

/// What to do with a run that has ended.
struct Measuring {
  std::vector<Measure> measures;
  bool measures_failed = false;
};

/// Look at the folder of a run whose process ended with `status` (as waitpid gives it), without measuring.
[[nodiscard]] RunResult collect(const std::filesystem::path& folder, int status);

/// Take the measures from history.csv.
void measure(RunResult& result, const std::filesystem::path& folder, const Measuring& measuring);

void write_result(const std::filesystem::path& folder, const RunResult& result, const Measuring& measuring);

/// The result of an earlier study of the same run: measured anew where the history was kept, and recorded so where
/// the measures have changed. Nothing, if there is none, it is of another run, its history was altered, or it cannot be
/// measured as it is asked now.
[[nodiscard]] std::optional<RunResult> read_result(const std::filesystem::path& folder, const std::string& fingerprint,
                                                   const Measuring& measuring);

/// Remove what shall not stay of a finished run: keep "history", "none" or "all". Failed runs, and those with a
/// measure that could not be taken, stay whole but for result files.
void tidy(const std::filesystem::path& folder, const RunResult& result, const std::string& keep);

} // namespace mullion::study
