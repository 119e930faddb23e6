// [[plot]] of a study file: histories of its runs over one another, as figures of papers show them. The study only
// writes them down in study.json; `mullion report` draws them from the kept histories.
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"

#include <string>
#include <vector>

namespace mullion::study {

/// One picture for each combination of all axes but `curves`, which makes the curves.
struct PlotSpec {
  std::string title, x_label = "time [s]", y, y_label, curves, normalise = "none";
  double x_scale = 1.0, y_scale = 1.0, from = 0.0, to = 0.0, until = 0.0;

  /// The columns of history.csv whose product is drawn: `y` is "a" or "a * b".
  [[nodiscard]] std::vector<std::string> factors() const;
};

/// All [[plot]]; @param axes  names of the study's axes, for `curves`
[[nodiscard]] std::vector<PlotSpec> read_plots(const config::Node& root, const std::vector<std::string>& axes,
                                               config::Diagnostics& diagnostics);

} // namespace mullion::study
