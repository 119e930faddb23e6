// Draws plots and pictures with gnuplot: one child process for all of them, in a temporary folder that is gone
// afterwards. Nothing of it is left if it fails; if this process is killed, the folder stays in the system's temporary
// folder.
#pragma once

#include "report/picture.hpp"
#include "report/plot.hpp"

#include <string>
#include <variant>
#include <vector>

namespace mullion::report {

/// What is drawn, and stands on the page with a title above and a caption below.
using Figure = std::variant<Plot, Picture>;

/// A figure as the bytes of two files.
struct Drawing {
  std::string svg; ///< none of a picture of more than max_svg_cells
  std::string png;
};

/// @param figures  their names differ
/// @return         one a figure
/// @throws Error Errc::process: no gnuplot (names the package), or it failed (with what it says); Errc::io
[[nodiscard]] std::vector<Drawing> draw(const std::vector<Figure>& figures);

} // namespace mullion::report
