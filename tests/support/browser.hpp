// A page in headless Chromium, as a reader without a network sees it: whether it loads anything, whether anything is
// cut off or drawn over. The measuring script goes into a copy of the page; the page itself has none.
#pragma once

#include <filesystem>
#include <string>

namespace mullion::test {

/// Is there a Chromium on the PATH?
bool has_browser();

struct PageLooks {
  int n_plots = 0;  ///< SVG elements
  int n_texts = 0;  ///< in them
  int n_loaded = 0; ///< things that the page asked for besides itself
  std::string
      problems; ///< a line each: what is wider than the page, cut off by its plot, or over another text; "": fine
};

/// Open the page and measure it. @param scratch  a folder for the copy and the browser's profile
/// @throws std::runtime_error if the browser fails or the script did not run
PageLooks look_at(const std::filesystem::path& page, const std::filesystem::path& scratch);

} // namespace mullion::test
