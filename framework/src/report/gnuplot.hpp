// Draws plots with gnuplot: one child process for all of them, in a temporary folder that is gone afterwards. Nothing
// of it is left if it fails; if this process is killed, the folder stays in the system's temporary folder.
#pragma once

#include "report/plot.hpp"

#include <string>
#include <vector>

namespace mullion::report {

/// A plot as the bytes of two files.
struct Drawing {
  std::string svg, png;
};

/// @param plots  their names differ
/// @return       one a plot
/// @throws Error Errc::process: no gnuplot (names the package), or it failed (with what it says); Errc::io
[[nodiscard]] std::vector<Drawing> draw(const std::vector<Plot>& plots);

} // namespace mullion::report
