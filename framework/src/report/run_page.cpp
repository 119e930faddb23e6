// The report about a run: what was run, how it went, its fields in pictures, its history in plots, where the time went,
// and its case. Nothing of it is required: a run that failed early, or is still going on, has less to show.
#include "report/page.hpp"

#include "io/atomic_file.hpp"
#include "io/run_record.hpp"
#include "report/csv_table.hpp"
#include "report/decimate.hpp"
#include "report/field_pictures.hpp"
#include "report/group_curves.hpp"
#include "report/html.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t n_buckets = 700; // a plot is not many pixels wider
constexpr std::size_t few_points = 40; // each can have a mark of its own

std::string heading(const std::string& text) { return "<h2>" + escape(text) + "</h2>\n"; }

std::string paragraph(const std::string& text) { return "<p>" + escape(text) + "</p>\n"; }

std::string seconds(double value)
{
  if (!std::isfinite(value)) return "unknown";
  if (value < 1e-3) return fmt::format("{:.1f} us", value * 1e6);
  return value < 1.0 ? fmt::format("{:.1f} ms", value * 1e3) : fmt::format("{:.2f} s", value);
}

std::string with_unit(const std::string& name, const std::string& unit)
{
  return unit.empty() ? name : fmt::format("{} [{}]", name, unit);
}

// ---- what was run ------------------------------------------------------------------------------------------------

void add_facts(Page& page, const io::RunRecord& record)
{
  page.title = "Run " + record.name;
  page.add(fmt::format("<h1>Run {}</h1>\n<p class=\"outcome {}\">{}</p>\n", escape(record.name), escape(record.outcome),
                       escape(record.outcome)));
  if (record.outcome == "running")
    page.add(
        paragraph("The run goes on, or ended without anyone left to say how: this is what it has written so far."));
  if (record.attempts.empty()) return;
  const auto& attempt = record.attempts.back();
  if (!attempt.error.empty() && attempt.outcome == "failed")
    page.add(fmt::format("<div class=\"error\">{}</div>\n", escape(attempt.error)));

  Table facts;
  if (attempt.outcome == "stopped" && !attempt.error.empty()) facts.rows.push_back({"stopped by", attempt.error});
  facts.rows.push_back({"driver", attempt.driver});
  if (attempt.outcome != "running") {
    const auto n_steps = attempt.steps - attempt.first_step;
    facts.rows.push_back({"steps", fmt::format("{}", attempt.steps)});
    facts.rows.push_back({"simulated to", fmt::format("{} s", attempt.simulated_time)});
    facts.rows.push_back({"wall time", seconds(attempt.wall_s)});
    if (n_steps > 0)
      facts.rows.push_back({"wall time per step", seconds(attempt.wall_s / static_cast<double>(n_steps))});
  }
  facts.rows.push_back({"start", attempt.start});
  for (const auto& [what, version] : attempt.versions) facts.rows.push_back({what, version});
  page.add(table_html(facts));
}

void add_modules(Page& page, const io::Attempt& attempt)
{
  if (attempt.modules.empty()) return;
  page.add(heading("Modules"));
  Table table{{"instance", "kind", "plug-in", "version", "runs"}, {}};
  for (const auto& module : attempt.modules)
    table.rows.push_back({module.instance, module.kind, module.module, module.version,
                          module.is_process ? "in a process of its own" : "inline"});
  page.add(table_html(table));
}

// ---- history -----------------------------------------------------------------------------------------------------

const char* title_of(Section section)
{
  switch (section) {
  case Section::interface: return "Interface";
  case Section::outputs: return "Outputs";
  case Section::energies: return "Energies";
  case Section::ledger: return "Ledger";
  case Section::driver: return "Driver";
  case Section::residuals: return "Residuals";
  }
  return "";
}

/// "displacement", or "velocity, sound_speed" of several.
std::string quantities(const std::vector<const CsvColumn*>& columns)
{
  std::vector<std::string> names;
  for (const auto* column : columns)
    if (auto name = quantity_of(column->name); std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(std::move(name));
  constexpr std::size_t at_most = 4; // as many as fit beside the axis
  std::string text;
  for (std::size_t i = 0; i < std::min(names.size(), at_most); ++i) text += (i == 0 ? "" : ", ") + names[i];
  return names.size() > at_most ? text + ", …" : text;
}

/// Whether a logarithmic axis has anything to show.
bool has_positive(const CurveGroup& group)
{
  const auto is_positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  return std::any_of(group.columns.begin(), group.columns.end(), [&](const CsvColumn* column) {
    return std::any_of(column->numbers.begin(), column->numbers.end(), is_positive);
  });
}

struct Omitted {
  std::size_t not_finite = 0, not_positive = 0;
};

/// The column as it is drawn: energies as changes since the start, others without what a logarithm cannot show.
std::vector<double> drawn_values(const CsvColumn& column, Section section, bool is_log, Omitted& omitted)
{
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double start = first_value(column);
  auto values = column.numbers;
  for (double& value : values) {
    if (section == Section::energies && std::isfinite(value)) value -= start;
    if (!std::isfinite(value)) ++omitted.not_finite;
    else if (is_log && value <= 0.0) ++omitted.not_positive, value = none;
  }
  return values;
}

std::string caption(std::size_t n_rows, bool is_thinned, const Omitted& omitted)
{
  std::string text;
  if (is_thinned)
    text +=
        fmt::format("{} steps, thinned out for the drawing: of each of {} equal intervals of time the first, smallest, "
                    "largest and last value.",
                    n_rows, n_buckets);
  if (omitted.not_finite > 0)
    text += fmt::format("{}{} values are not finite and left out.", text.empty() ? "" : " ", omitted.not_finite);
  if (omitted.not_positive > 0)
    text += fmt::format("{}{} values are not positive and left out.", text.empty() ? "" : " ", omitted.not_positive);
  return text;
}

bool starts_elsewhere(const CsvColumn* column) { return first_value(*column) != 0.0; } // than at zero

Plot history_plot(const CurveGroup& group, const std::vector<double>& time)
{
  Plot plot;
  Omitted omitted;
  bool is_thinned = false;
  const bool is_log = group.section == Section::residuals && has_positive(group);
  for (const auto* column : group.columns) {
    const auto values = drawn_values(*column, group.section, is_log, omitted);
    auto& curve = plot.curves.emplace_back();
    curve.title = column->name;
    if (group.section == Section::energies && starts_elsewhere(column))
      curve.title += fmt::format(" (starts at {:.6g} {})", first_value(*column), group.unit);
    for (const auto i : decimate(time, values, n_buckets)) {
      curve.x.push_back(time[i]);
      curve.y.push_back(values[i]);
    }
    is_thinned = is_thinned || curve.x.size() < time.size();
  }
  const auto what = quantities(group.columns);
  const bool is_alone = group.columns.size() == 1;
  const auto label = is_alone ? group.columns.front()->name : what;
  plot.name = file_name(std::string(title_of(group.section)) + "-" + what);
  plot.title = is_alone ? label : fmt::format("{}: {}", title_of(group.section), what);
  const bool is_change =
      group.section == Section::energies && std::any_of(group.columns.begin(), group.columns.end(), starts_elsewhere);
  if (is_change) plot.title += ", change since the start";
  plot.shape = time.size() <= few_points ? Shape::marked : Shape::lines;
  plot.x = {"time [s]", false};
  plot.y = {with_unit((is_change ? "change of " : "") + label, group.unit), is_log};
  plot.caption = caption(time.size(), is_thinned, omitted);
  return plot;
}

void add_history(Page& page, const fs::path& folder, const io::RunRecord& record)
{
  const auto file = folder / "history.csv";
  const auto nothing = [&](const std::string& why) {
    page.add(heading("History"));
    page.add(paragraph(why));
  };
  if (!fs::exists(file)) return nothing("There is no history.csv: the run wrote none, or ended before its first step.");
  if (fs::file_size(file) == 0) return nothing("history.csv is empty.");
  const auto text = io::read_text(file);
  if (text.find('\n') == std::string::npos) return nothing("history.csv has no whole header.");
  const auto history = parse_csv(text, file.string(), LastLine::may_be_cut);
  const auto* time = history.find("time");
  MULLION_REQUIRE(time != nullptr && !time->is_text(), Errc::io,
                  "{}: no column 'time' of numbers, so this is no history of a run", file.string());
  if (history.n_rows == 0) return nothing("history.csv has a header and no rows.");
  const std::map<std::string, std::string> units(record.columns.begin(), record.columns.end());
  const auto groups = group_curves(history, units);
  std::string without_values;
  for (const auto& column : history.columns)
    if (!has_values(column)) without_values += (without_values.empty() ? "" : ", ") + column.name;
  if (groups.empty() && without_values.empty()) return nothing("history.csv has no columns but step and time.");
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (g == 0 || groups[g].section != groups[g - 1].section) page.add(heading(title_of(groups[g].section)));
    page.add(history_plot(groups[g], time->numbers));
  }
  if (!without_values.empty()) page.add(paragraph("Columns of history.csv without a finite number: " + without_values));
}

// ---- timings, attempts, case -------------------------------------------------------------------------------------

void add_timings(Page& page, const io::Attempt& attempt)
{
  if (attempt.timings.empty()) return;
  page.add(heading("Timings"));
  Plot plot;
  plot.name = "timings";
  plot.title = "Wall time, by call";
  plot.shape = Shape::bars;
  plot.x = {"wall time [s]", false};
  Curve work{"work of the module", {}, {}}, waiting{"waiting of the caller", {}, {}};
  Table table{{"who", "call", "calls", "work", "waiting", "share"}, {}};
  for (const auto& t : attempt.timings) {
    const auto row = static_cast<double>(plot.labels.size());
    plot.labels.push_back(t.who + " " + t.call);
    work.x.push_back(t.work_s);
    waiting.x.push_back(t.wait_s);
    work.y.push_back(row);
    waiting.y.push_back(row);
    const double share = 100.0 * t.wall_s / attempt.wall_s;
    table.rows.push_back({t.who, t.call, fmt::format("{}", t.count), seconds(t.work_s), seconds(t.wait_s),
                          std::isfinite(share) ? fmt::format("{:.1f} %", share) : ""});
  }
  plot.curves = {work, waiting};
  plot.caption =
      "Of the last attempt. Waiting is what a call takes beyond the module's own work: waking its process, and "
      "other processes on the same cores.";
  page.add(plot);
  page.add(table_html(table));
}

void add_attempts(Page& page, const io::RunRecord& record)
{
  page.add(heading("Attempts"));
  Table table{{"start", "outcome", "driver", "from", "first step", "steps", "to time", "wall time", "message"}, {}};
  Table events{{"attempt", "step", "what", "instance", "detail"}, {}};
  for (std::size_t a = 0; a < record.attempts.size(); ++a) {
    const auto& attempt = record.attempts[a];
    const auto from = attempt.restarted_from.empty() ? "initial state" : attempt.restarted_from;
    table.rows.push_back({attempt.start, attempt.outcome, attempt.driver, from, fmt::format("{}", attempt.first_step),
                          fmt::format("{}", attempt.steps), fmt::format("{:.6g} s", attempt.simulated_time),
                          seconds(attempt.wall_s), attempt.error});
    table.classes.push_back(attempt.outcome == "failed" ? "failed" : "");
    for (const auto& event : attempt.events)
      events.rows.push_back(
          {fmt::format("{}", a + 1), fmt::format("{}", event.step), event.what, event.instance, event.detail});
  }
  page.add(table_html(table));
  if (!events.rows.empty()) page.add(heading("Events") + table_html(events));
}

void add_case(Page& page, const fs::path& folder)
{
  if (!fs::exists(folder / "case.toml")) return;
  page.add(heading("Case") + "<details><summary>case.toml, as it was run</summary>\n<pre>" +
           escape(io::read_text(folder / "case.toml")) + "</pre></details>\n");
}

} // namespace

Page run_page(const fs::path& folder)
{
  const auto record = io::read_run_record(folder / "run.json");
  MULLION_REQUIRE(record.has_value(), Errc::io, "there is no {}", (folder / "run.json").string());
  Page page;
  add_facts(page, *record);
  if (!record->attempts.empty()) add_modules(page, record->attempts.back());
  add_field_pictures(page, folder);
  add_history(page, folder, *record);
  if (!record->attempts.empty()) add_timings(page, record->attempts.back());
  add_attempts(page, *record);
  add_case(page, folder);
  return page;
}

} // namespace mullion::report
