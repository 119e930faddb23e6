// The report about a run or a study: what `mullion report` does, for the command line and bindings.
#pragma once

#include <cstddef>
#include <string>

namespace mullion {

struct Report {
  std::string file;        ///< report.html
  std::size_t n_plots = 0; ///< in it, and beside it as SVG and PNG
};

/// Write `folder`/report/: report.html, one file that opens without a network, and its plots in plots/.
/// @param folder  of a run (run.json) or a study (study.json)
/// @throws Error  Errc::config: the folder is neither; Errc::io: one of its files is damaged, or the report cannot be
///                written; Errc::process: gnuplot is missing or failed
Report write_report(const std::string& folder);

} // namespace mullion
