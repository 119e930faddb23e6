// Run a case from its file to its results: what `mullion run` does, for the command line and bindings.
#pragma once

#include <mullion/app/case_file.hpp>

#include <string>

namespace mullion {

struct RunOptions {
  std::string case_file; ///< with restart it may be "": the case that the checkpoint holds
  CaseOptions case_options;
  std::string out;     ///< results folder; "" is out/<run name>
  std::string restart; ///< a checkpoint's file, or "latest": the newest good one of the results folder; "": a new run
  bool replay = false; ///< every step twice from restored windows, compared byte for byte
  int amnesia = 0;     ///< every K-th step again by fresh processes and a new driver; 0: never
  bool has_deadlines = true;
  bool has_summary = true;
  std::string log_level = "info";
};

/// Run a case under a guard process. Messages go to standard error, the summary to standard output.
/// @return the exit code: 0 done (or ended early as asked), 1 the run failed, 2 the case is wrong
int run_case(const RunOptions& options);

} // namespace mullion
