// A study file: which case, what every run overrides, what varies, and what is measured. Reading collects all
// mistakes, each with its place; whether the case knows the keys is asked later, run by run (study/plan.hpp).
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"
#include "study/measure_table.hpp"
#include "study/plot_table.hpp"

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace mullion::study {

/// An override that a run gets, as --set takes it.
struct Setting {
  std::string key, value; ///< the value as TOML
  config::Place place;

  [[nodiscard]] std::string override_text() const { return key + "=" + value; }
};

/// One place on an axis.
struct Point {
  std::vector<std::string> cells; ///< what the table shows, a text for each of the axis's columns
  std::vector<Setting> settings;
  std::vector<ParameterValue> measure; ///< parameters of the measures here
};

/// One [[vary]].
struct Axis {
  std::string name;                 ///< of labelled points; else its keys
  std::vector<std::string> columns; ///< of the study's table
  std::vector<std::string> keys;    ///< that it sets
  bool is_labelled = false;
  std::vector<bool> is_numeric; ///< are all cells of a column numbers?
  std::vector<Point> points;
};

struct StudyFile {
  std::string file;
  std::string name;
  std::string case_file; ///< found from the study file's folder
  std::string placement = "inline", keep = "history";
  bool measures_failed = false;
  std::vector<Setting> settings;
  std::vector<Axis> axes;
  std::vector<MeasureSpec> measures;
  std::vector<PlotSpec> plots;
  References references;
  std::string text; ///< the file as it stands
  /// What the finished runs in a folder depend on, part by part, as TOML: two files that agree in it may share one.
  std::vector<std::pair<std::string, std::string>> identity;

  [[nodiscard]] std::size_t n_runs() const;
  /// The point on each axis of a run; the last axis varies fastest.
  [[nodiscard]] std::vector<const Point*> points_of(std::size_t run) const;
  /// [set], then the points'.
  [[nodiscard]] std::vector<const Setting*> settings_of(std::size_t run) const;
  [[nodiscard]] std::vector<Measure> measures_of(std::size_t run) const;
  /// "driver.kappa = 0.2, scheme = A": which run it is, in words.
  [[nodiscard]] std::string describe_run(std::size_t run) const;
};

/// Read and check. The value can be used if there are no diagnostics.
struct StudyFileResult {
  StudyFile value;
  config::Diagnostics diagnostics;
  std::string problem; ///< the file itself cannot be read
};
[[nodiscard]] StudyFileResult read_study(const std::string& file);

/// The same from a text that was read before; paths in it count from the folder of `file`.
[[nodiscard]] StudyFileResult parse_study(const std::string& text, const std::string& file);

/// How two studies differ in their identity, a line per part; "" if they don't.
[[nodiscard]] std::string difference(const StudyFile& there, const StudyFile& here);

// ---- the parts of it, a file each ----

/// All [[vary]] (axes.cpp).
[[nodiscard]] std::vector<Axis> read_axes(const config::Node& root, const std::vector<MeasureSpec>& measures,
                                          config::Diagnostics& diagnostics);

/// `{ "driver.omega" = 0.1, … }`; a table within it, as unquoted dots make one, is the same.
[[nodiscard]] std::vector<Setting> read_settings(const config::Node& node, const char* label,
                                                 config::Diagnostics& diagnostics);

/// Is this a key that a study may set? If not, that is reported.
bool check_key(const std::string& key, const config::Place& place, const char* label, config::Diagnostics& diagnostics);

/// Can this be a column of the study's table? If not, that is reported.
bool check_column(const std::string& name, const config::Place& place, const char* label,
                  config::Diagnostics& diagnostics);

} // namespace mullion::study
