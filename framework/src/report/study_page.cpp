// The report about a study: each measure over the varied keys, and the table of all runs. The axis with the most
// distinct numbers is drawn along x, a curve for each combination of the others; where no axis has numbers, a row for
// each label.
#include "report/page.hpp"

#include "io/atomic_file.hpp"
#include "report/csv_table.hpp"
#include "report/html.hpp"
#include "report/overlay.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// What was varied, and the column that says how far.
struct StudyAxis {
  std::string name;
  std::string label; ///< with its unit, if study.json tells one
  const CsvColumn* column = nullptr;
  std::size_t n_distinct = 0;
};

struct Measure {
  std::string name, kind, quantity, unit;
};

struct Study {
  std::string name, the_case;
  std::vector<StudyAxis> axes;
  std::vector<Measure> measures;
  Json plots = Json::array(); ///< histories to draw over one another
  CsvTable table;
};

std::string cell(const CsvColumn& column, std::size_t row, int digits)
{
  if (column.is_text()) return column.texts[row];
  return std::isnan(column.numbers[row]) ? "" : fmt::format("{:.{}g}", column.numbers[row], digits);
}

/// Keys and labels are told apart by what the table would show of them.
constexpr int digits_of_keys = 12, digits_of_measures = 6;

std::string key_cell(const CsvColumn& column, std::size_t row) { return cell(column, row, digits_of_keys); }

std::vector<std::string> distinct(const CsvColumn& column)
{
  std::vector<std::string> values;
  std::set<std::string> seen;
  for (std::size_t row = 0; row < std::max(column.texts.size(), column.numbers.size()); ++row)
    if (auto value = key_cell(column, row); seen.insert(value).second) values.push_back(std::move(value));
  return values;
}

std::string text_of(const Json& json, const char* key)
{
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Of an axis with several keys that vary together, the column whose numbers differ most. Labels have one column, by
/// the axis' name.
StudyAxis read_axis(const Json& json, const CsvTable& table, const std::string& file)
{
  const auto own = text_of(json, "name");
  auto names = json.value("columns", std::vector<std::string>{});
  if (names.empty()) {
    const auto labels = json.find("labels");
    if (labels == json.end() || !labels->is_array()) names = json.value("keys", std::vector<std::string>{});
    names.push_back(own);
  }
  StudyAxis axis;
  for (const auto& name : names) {
    const auto* column = table.find(name);
    if (column == nullptr) continue;
    const auto n = distinct(*column).size();
    const bool is_better = axis.column == nullptr || (!column->is_text() && axis.column->is_text()) ||
                           (column->is_text() == axis.column->is_text() && n > axis.n_distinct);
    if (is_better) axis = {own, name, column, n};
  }
  MULLION_REQUIRE(axis.column != nullptr, Errc::io, "{}: axis '{}' has no column of its own in study.csv", file, own);
  if (const auto unit = text_of(json, "unit"); !unit.empty()) axis.label += fmt::format(" [{}]", unit);
  return axis;
}

Study read_study(const fs::path& folder)
{
  const auto file = (folder / "study.json").string();
  Study study;
  study.table = read_csv(folder / "study.csv", LastLine::whole);
  try {
    const auto json = Json::parse(io::read_text(file));
    study.name = json.at("name").get<std::string>();
    study.the_case = text_of(json, "case");
    for (const auto& axis : json.at("axes")) study.axes.push_back(read_axis(axis, study.table, file));
    for (const auto& m : json.at("measures"))
      study.measures.push_back(
          {m.at("name").get<std::string>(), text_of(m, "kind"), text_of(m, "quantity"), text_of(m, "unit")});
    study.plots = json.value("plots", Json::array());
  } catch (const nlohmann::json::exception& failure) {
    throw Error(Errc::io, fmt::format("{} does not describe a study: {}", file, failure.what()));
  }
  return study;
}

// ---- plots -------------------------------------------------------------------------------------------------------

/// The axis to draw along x: of the numeric ones that with most values, else of the others. @return nullptr: none
/// varies
const StudyAxis* choose_x(const Study& study)
{
  const StudyAxis* best = nullptr;
  for (const auto& axis : study.axes) {
    if (axis.n_distinct < 2) continue;
    const bool is_better = best == nullptr || (best->column->is_text() && !axis.column->is_text()) ||
                           (best->column->is_text() == axis.column->is_text() && axis.n_distinct > best->n_distinct);
    if (is_better) best = &axis;
  }
  return best;
}

/// "driver.kappa = 0.2, CSS": where a run lies on the axes that are not drawn along x.
std::string combination(const Study& study, const StudyAxis& x, std::size_t row)
{
  std::string text;
  for (const auto& axis : study.axes) {
    if (&axis == &x || axis.n_distinct < 2) continue;
    if (!text.empty()) text += ", ";
    text += axis.column->is_text() ? key_cell(*axis.column, row)
                                   : fmt::format("{} = {}", axis.column->name, key_cell(*axis.column, row));
  }
  return text;
}

bool wants_log(const std::vector<double>& values)
{
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low > 0.0 && std::isfinite(low) && high > 100.0 * low;
}

/// Where the runs lie along x: the numbers, or the place of each label.
std::vector<double> places(const StudyAxis& x)
{
  if (!x.column->is_text()) return x.column->numbers;
  const auto labels = distinct(*x.column);
  std::vector<double> rows;
  for (const auto& label : x.column->texts)
    rows.push_back(static_cast<double>(std::find(labels.begin(), labels.end(), label) - labels.begin()));
  return rows;
}

void sort_by_x(Curve& curve)
{
  std::vector<std::pair<double, double>> points;
  for (std::size_t i = 0; i < curve.x.size(); ++i) points.emplace_back(curve.x[i], curve.y[i]);
  std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  for (std::size_t i = 0; i < points.size(); ++i) std::tie(curve.x[i], curve.y[i]) = points[i];
}

std::string title_of(const Measure& measure)
{
  auto text = measure.name;
  if (!measure.kind.empty() && measure.kind != measure.name) text += ": " + measure.kind;
  return measure.quantity.empty() ? text : text + " of " + measure.quantity;
}

/// One curve a combination that has values, in the order of the runs; and the bounds of runs that have no value.
std::vector<Curve> curves_of(const Study& study, const StudyAxis& x, const Measure& measure, const CsvColumn& values)
{
  const auto at = places(x);
  const auto* bounds = study.table.find(measure.name + ".bound");
  std::vector<Curve> curves;
  std::map<std::string, std::size_t> known;
  Curve bound{"bound, where there is no value", {}, {}, true};
  for (std::size_t row = 0; row < study.table.n_rows; ++row) {
    if (!std::isfinite(at[row])) continue;
    const auto title = combination(study, x, row);
    const auto [entry, is_new] = known.try_emplace(title, curves.size());
    if (is_new) curves.push_back({title, {}, {}});
    auto& curve = curves[entry->second];
    curve.x.push_back(at[row]);
    curve.y.push_back(values.numbers[row]);
    const bool has_bound = bounds != nullptr && !bounds->is_text() && std::isfinite(bounds->numbers[row]);
    if (std::isnan(values.numbers[row]) && has_bound) {
      bound.x.push_back(at[row]);
      bound.y.push_back(bounds->numbers[row]);
    }
  }
  if (!bound.x.empty()) curves.push_back(std::move(bound));
  int style = 0; // the same for a combination in all plots, also where others have no value
  for (auto& curve : curves) {
    curve.style = style++;
    if (curve.title.empty()) curve.title = measure.name;
    sort_by_x(curve);
  }
  std::erase_if(curves, [](const Curve& curve) {
    return std::none_of(curve.y.begin(), curve.y.end(), [](double y) { return std::isfinite(y); });
  });
  return curves;
}

void add_measure(Page& page, const Study& study, const StudyAxis& x, const Measure& measure)
{
  const auto* values = study.table.find(measure.name);
  const auto nothing = [&](const char* why) {
    page.add(fmt::format("<p>{}: {}</p>\n", escape(title_of(measure)), why));
  };
  if (values == nullptr) return nothing("study.csv has no such column.");
  if (values->is_text()) return nothing("not all of its values are numbers, so there is no plot.");
  auto curves = curves_of(study, x, measure, *values);
  if (curves.empty()) return nothing("no run has a value.");

  std::vector<double> all_values;
  for (const auto& curve : curves) all_values.insert(all_values.end(), curve.y.begin(), curve.y.end());
  const auto label = measure.unit.empty() ? measure.name : fmt::format("{} [{}]", measure.name, measure.unit);
  Plot plot;
  plot.name = file_name(measure.name);
  plot.y = {label, wants_log(all_values)};
  if (x.column->is_text()) {
    plot.shape = Shape::dots;
    plot.labels = distinct(*x.column);
    plot.x = plot.y;
    for (auto& curve : curves) std::swap(curve.x, curve.y);
  } else {
    plot.shape = Shape::marked;
    plot.x = {x.label, wants_log(x.column->numbers)};
  }
  const auto n_plots = (curves.size() + max_curves - 1) / max_curves;
  for (std::size_t p = 0; p < n_plots; ++p) {
    plot.title =
        title_of(measure) + ", over " + x.label + (n_plots == 1 ? "" : fmt::format(", part {} of {}", p + 1, n_plots));
    plot.curves.assign(curves.begin() + static_cast<long>(p * max_curves),
                       curves.begin() + static_cast<long>(std::min(curves.size(), (p + 1) * max_curves)));
    page.add(plot);
  }
}

/// The [[plot]] tables of the study: histories over one another.
void add_overlays(Page& page, const fs::path& folder, const Study& study)
{
  if (study.plots.empty()) return;
  page.add("<h2>Histories</h2>\n");
  std::vector<const CsvColumn*> columns;
  for (const auto& axis : study.axes) columns.push_back(axis.column);
  for (const auto& plot : study.plots) {
    const auto found = std::find_if(study.axes.begin(), study.axes.end(),
                                    [&](const auto& axis) { return axis.name == text_of(plot, "curves"); });
    const auto curves = static_cast<std::size_t>(found - study.axes.begin());
    add_overlay(page, folder, plot, study.table, columns, curves == columns.size() ? 0 : curves);
  }
}

// ---- the table ---------------------------------------------------------------------------------------------------

void add_runs(Page& page, const Study& study)
{
  const auto* outcome = study.table.find("outcome");
  std::set<std::string> keys;
  for (const auto& column : study.table.columns) {
    if (column.name == "outcome") break; // before it stand the keys
    keys.insert(column.name);
  }
  Table table;
  for (const auto& column : study.table.columns) table.header.push_back(column.name);
  for (std::size_t row = 0; row < study.table.n_rows; ++row) {
    auto& cells = table.rows.emplace_back();
    for (const auto& column : study.table.columns)
      cells.push_back(cell(column, row, keys.contains(column.name) ? digits_of_keys : digits_of_measures));
    const bool is_failed = outcome != nullptr && outcome->is_text() && outcome->texts[row] == "failed";
    table.classes.push_back(is_failed ? "failed" : "");
  }
  page.add("<h2>Runs</h2>\n" + table_html(table));
}

void add_facts(Page& page, const Study& study)
{
  page.title = "Study " + study.name;
  std::map<std::string, std::size_t> outcomes;
  if (const auto* outcome = study.table.find("outcome"); outcome != nullptr)
    for (const auto& text : outcome->texts) ++outcomes[text];
  const auto n_failed = outcomes["failed"];
  const auto n_completed = outcomes["completed"];
  page.add(fmt::format("<h1>Study {}</h1>\n<p class=\"outcome {}\">{} of {} runs completed{}</p>\n", escape(study.name),
                       n_failed > 0                       ? "failed"
                       : n_completed < study.table.n_rows ? "stopped"
                                                          : "completed",
                       n_completed, study.table.n_rows, n_failed > 0 ? fmt::format(", {} failed", n_failed) : ""));
  Table facts;
  facts.rows.push_back({"case", study.the_case});
  for (const auto& axis : study.axes) {
    std::string values;
    const auto all = distinct(*axis.column);
    constexpr std::size_t at_most = 12;
    for (std::size_t i = 0; i < std::min(all.size(), at_most); ++i) values += (i == 0 ? "" : ", ") + all[i];
    if (all.size() > at_most) values += fmt::format(", … {} ({} values)", all.back(), all.size());
    facts.rows.push_back({"varied: " + axis.label, values});
  }
  page.add(table_html(facts));
}

} // namespace

Page study_page(const fs::path& folder)
{
  const auto study = read_study(folder);
  Page page;
  add_facts(page, study);
  page.add("<h2>Measures</h2>\n");
  const auto* x = choose_x(study);
  if (study.measures.empty()) page.add("<p>The study takes no measures.</p>\n");
  else if (x == nullptr) page.add("<p>No key has more than one value: there is nothing to plot over.</p>\n");
  else
    for (const auto& measure : study.measures) add_measure(page, study, *x, measure);
  add_overlays(page, folder, study);
  add_runs(page, study);
  return page;
}

} // namespace mullion::report
