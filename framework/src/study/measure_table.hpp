// [[measure]] of a study file: which kinds there are, the keys that each takes, and how the parameters that a point
// gives are merged into it.
#pragma once

#include "config/diagnostics.hpp"
#include "config/toml_document.hpp"
#include "study/measures.hpp"

#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace mullion::study {

/// A measure as the study file gives it.
struct MeasureSpec {
  std::string name, kind;
  std::vector<ParameterValue> parameters; ///< all that its kind takes
  std::vector<std::pair<std::string, double>> terms;
  config::Node node; ///< the table, for places
};

/// Where a key of the measure stands; the table, if it is not given.
[[nodiscard]] config::Place place_of(const MeasureSpec& measure, const std::string& key);

/// Reference data by the path under which the study file names them.
using References = std::map<std::string, ColumnTable>;

/// All [[measure]] of a document; what is wrong is reported and left out.
[[nodiscard]] std::vector<MeasureSpec> read_measures(const config::Node& root, config::Diagnostics& diagnostics);

/// `measure = { … }` of a point: parameters for every measure whose kind takes them.
[[nodiscard]] std::vector<ParameterValue> read_point_measure(const config::Node& node,
                                                             const std::vector<MeasureSpec>& measures,
                                                             config::Diagnostics& diagnostics);

/// The value of a text parameter; "" if it is not one of them.
[[nodiscard]] std::string text_of(const std::vector<ParameterValue>& parameters, const std::string& name);

/// The measure for a run: of several points that give a parameter the last one wins.
[[nodiscard]] Measure make_measure(const MeasureSpec& spec,
                                   std::span<const std::vector<ParameterValue>* const> of_points,
                                   const References& references);

/// What a measure is, in one text: where two runs differ in it, stored values of one don't hold for the other.
[[nodiscard]] std::string definition_of(const Measure& measure);

} // namespace mullion::study
