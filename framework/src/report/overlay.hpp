// Histories of a study's runs over one another: the [[plot]] tables of the study file, as study.json hands them on.
#pragma once

#include "report/csv_table.hpp"
#include "report/page.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>

namespace mullion::report {

/// Draw one [[plot]]: a picture for each combination of all axes but the one that makes the curves. Runs without a
/// history, or with a shorter one, are drawn as far as they came; what is missing is said under the picture.
/// @param plot    its entry in study.json
/// @param axes    the columns of study.csv that tell the runs apart, one an axis
/// @param curves  the number of the axis that makes the curves
void add_overlay(Page& page, const std::filesystem::path& folder, const nlohmann::json& plot, const CsvTable& table,
                 const std::vector<const CsvColumn*>& axes, std::size_t curves);

} // namespace mullion::report
