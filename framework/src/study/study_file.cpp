#include "study/study_file.hpp"

#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"
#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/parameters.hpp>

#include <algorithm>
#include <filesystem>
#include <set>
#include <tuple>

namespace mullion::study {
namespace {

namespace fs = std::filesystem;
using config::Diagnostics;
using config::Node;
using config::Place;

constexpr std::size_t max_runs = 100'000; ///< more is a slip of the pen
constexpr std::size_t longest_name = 56;  ///< a run's name has 64 characters at most: ".99999" must fit behind

struct StudyOptions {
  std::string name, case_file, placement = "inline", keep = "history";
  bool measures_failed = false;
  static constexpr auto table()
  {
    using S = StudyOptions;
    return std::tuple{
        required_parameter("name", &S::name, "", "name of the study; its runs are <name>.<index>"),
        required_parameter("case", &S::case_file, "", "the case file, relative to the study file"),
        parameter("placement", &S::placement, "", "where the modules of the runs live",
                  one_of("inline", "processes", "as_case")),
        parameter("keep", &S::keep, "", "what stays of a finished run", one_of("history", "none", "all")),
        parameter("measure_failed", &S::measures_failed, "", "take the measures of failed runs too, up to their end")};
  }
};

bool is_plain_name(const std::string& name)
{
  const auto is_legal = [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '.' || c == '_' ||
           c == '-';
  };
  return std::all_of(name.begin(), name.end(), is_legal) && name.find_first_not_of('.') != std::string::npos;
}

fs::path beside(const std::string& study_file, const std::string& path)
{
  return (fs::path(study_file).parent_path() / path).lexically_normal();
}

void read_header(const Node& root, StudyFile& study, Diagnostics& diagnostics)
{
  const auto* entry = root.table()->find("study");
  if (entry == nullptr || entry->value.table() == nullptr) {
    diagnostics.add(entry == nullptr ? Place{} : entry->place,
                    entry == nullptr ? "there is no [study]; add the table with name and case"
                                     : "'study' is no table here; write [study], once");
    return;
  }
  const auto values =
      config::read_parameters(entry->value, {"[study]", ""}, detail::parameter_specs<StudyOptions>(), {}, diagnostics);
  const auto options = detail::read_options<StudyOptions>(config::to_values(values).data());
  study.name = options.name;
  study.case_file = beside(study.file, options.case_file).string();
  study.placement = options.placement;
  study.keep = options.keep;
  study.measures_failed = options.measures_failed;
  const auto* name = entry->value.table()->find("name");
  const auto* case_file = entry->value.table()->find("case");
  std::error_code none;
  if (case_file != nullptr && values[1].is_given && !fs::is_regular_file(study.case_file, none))
    diagnostics.add(case_file->value.place, fmt::format("[study] case = {}: there is no file {}; expected the case "
                                                        "file, relative to the study file",
                                                        config::write_value(case_file->value), study.case_file));
  if (name != nullptr && values[0].is_given && (!is_plain_name(study.name) || study.name.size() > longest_name))
    diagnostics.add(name->value.place, fmt::format("[study] name = {} is no name of a study; expected 1 to {} letters, "
                                                   "digits, '.', '_' or '-', and not dots alone",
                                                   config::write_value(name->value), longest_name));
}

void flatten(const config::Table& table, const std::string& prefix, const char* label, std::vector<Setting>& settings,
             Diagnostics& diagnostics)
{
  for (const auto& entry : table.entries) {
    const auto key = prefix + entry.key;
    if (const auto* inner = entry.value.table()) flatten(*inner, key + ".", label, settings, diagnostics);
    else if (check_key(key, entry.place, label, diagnostics))
      settings.push_back({key, config::write_value(entry.value), entry.value.place});
  }
}

/// The file that a measure, or a point for it, names at `place`.
void read_reference(const MeasureSpec& measure, const std::string& file, const Place& place, StudyFile& study,
                    Diagnostics& diagnostics)
{
  if (file.empty()) return; // reported as missing
  const auto path = beside(study.file, file).string();
  try {
    if (!study.references.contains(file)) study.references.emplace(file, parse_columns(io::read_text(path), path));
  } catch (const Error& error) {
    diagnostics.add(place, fmt::format("[[measure]] {}: {}", measure.name, error.what()));
    return;
  }
  const auto& table = study.references.at(file);
  for (const char* key : {"time_column", "value_column"})
    if (const auto column = text_of(measure.parameters, key); !table.has(column))
      diagnostics.add(place_of(measure, key), fmt::format("[[measure]] {} = \"{}\" is no column of {}{}", key, column,
                                                          path, config::suggestion(column, table.names)));
}

void read_references(StudyFile& study, Diagnostics& diagnostics)
{
  for (const auto& measure : study.measures) {
    if (measure.kind != "reference_error") continue;
    const auto place = place_of(measure, "file");
    const auto before = diagnostics.size();
    read_reference(measure, text_of(measure.parameters, "file"), place, study, diagnostics);
    for (const auto& axis : study.axes)
      for (const auto& point : axis.points)
        if (diagnostics.size() == before)
          read_reference(measure, text_of(point.measure, "file"), place, study, diagnostics);
  }
}

/// A column that is there twice could not be told from the other.
void check_columns(const StudyFile& study, Diagnostics& diagnostics)
{
  std::set<std::string> names;
  for (const auto& axis : study.axes) names.insert(axis.columns.begin(), axis.columns.end());
  for (const auto& spec : study.measures) {
    if (spec.name.empty() || !check_column(spec.name, place_of(spec, "name"), "[[measure]] name", diagnostics))
      continue;
    Measure measure;
    measure.name = spec.name;
    measure.kind = spec.kind;
    for (const auto& column : columns_of(measure))
      if (!names.insert(column).second)
        diagnostics.add(place_of(spec, "name"),
                        fmt::format("[[measure]] name = \"{}\": there is another column '{}'; expected "
                                    "another name",
                                    spec.name, column));
  }
}

void check_settings(const StudyFile& study, Diagnostics& diagnostics)
{
  for (const auto& setting : study.settings)
    for (const auto& axis : study.axes)
      if (!axis.is_labelled && std::find(axis.keys.begin(), axis.keys.end(), setting.key) != axis.keys.end())
        diagnostics.add(setting.place, fmt::format("[set] \"{}\" is overruled by a [[vary]] in every run; expected one "
                                                   "of the two",
                                                   setting.key));
}

/// Two files agree in what was run if they agree in this.
std::vector<std::pair<std::string, std::string>> identity_of(Node root, bool with_measures)
{
  std::vector<std::pair<std::string, std::string>> identity;
  for (auto& entry : root.table()->entries) {
    if (auto* table = entry.value.table()) {
      for (const auto& key : table->entries)
        if (key.key != "measure_failed")
          identity.emplace_back(fmt::format("[{}] {}", entry.key, key.key), config::write_value(key.value));
    } else if (auto* list = std::get_if<config::List>(&entry.value.value);
               list != nullptr && entry.key != "plot" && (entry.key != "measure" || with_measures)) {
      int number = 0;
      for (auto& element : *list) {
        auto* const vary = element.table();
        auto* const points = vary == nullptr ? nullptr : vary->find("points");
        auto* const tables = points == nullptr ? nullptr : std::get_if<config::List>(&points->value.value);
        for (std::size_t p = 0; !with_measures && tables != nullptr && p < tables->size(); ++p)
          if (auto* point = (*tables)[p].table())
            std::erase_if(point->entries, [](const auto& key) { return key.key == "measure"; });
        identity.emplace_back(fmt::format("[[{}]] {}", entry.key, ++number), config::write_value(element));
      }
    }
  }
  std::sort(identity.begin(), identity.end());
  return identity;
}

} // namespace

std::size_t StudyFile::n_runs() const
{
  std::size_t n = 1;
  for (const auto& axis : axes) n *= axis.points.size();
  return n;
}

std::vector<const Point*> StudyFile::points_of(std::size_t run) const
{
  std::vector<const Point*> points(axes.size());
  for (std::size_t a = axes.size(); a-- > 0; run /= axes[a].points.size())
    points[a] = &axes[a].points[run % axes[a].points.size()];
  return points;
}

std::vector<const Setting*> StudyFile::settings_of(std::size_t run) const
{
  std::vector<const Setting*> all;
  for (const auto& setting : settings) all.push_back(&setting);
  for (const auto* point : points_of(run))
    for (const auto& setting : point->settings) all.push_back(&setting);
  return all;
}

std::vector<Measure> StudyFile::measures_of(std::size_t run) const
{
  std::vector<const std::vector<ParameterValue>*> of_points;
  for (const auto* point : points_of(run)) of_points.push_back(&point->measure);
  std::vector<Measure> all;
  for (const auto& spec : measures) all.push_back(make_measure(spec, of_points, references));
  return all;
}

std::string StudyFile::describe_run(std::size_t run) const
{
  std::vector<std::string> parts;
  const auto points = points_of(run);
  for (std::size_t a = 0; a < axes.size(); ++a)
    for (std::size_t c = 0; c < axes[a].columns.size(); ++c)
      parts.push_back(fmt::format("{} = {}", axes[a].columns[c], points[a]->cells[c]));
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::vector<Setting> read_settings(const Node& node, const char* label, Diagnostics& diagnostics)
{
  std::vector<Setting> settings;
  if (node.table() != nullptr) flatten(*node.table(), "", label, settings, diagnostics);
  else
    diagnostics.add(node.place,
                    fmt::format("{} = {}; expected {{ \"key\" = value, … }}", label, config::describe(node)));
  return settings;
}

bool check_key(const std::string& key, const Place& place, const char* label, Diagnostics& diagnostics)
{
  const auto parts = config::parse_key(key);
  if (!parts || parts->size() < 2) {
    diagnostics.add(place, fmt::format("{} '{}' is no key of a case; expected \"table.key\"", label, key));
    return false;
  }
  if (*parts == std::vector<std::string>{"run", "name"}) {
    diagnostics.add(place, fmt::format("{} '{}': the study names its runs itself; leave the key out", label, key));
    return false;
  }
  return true;
}

bool check_column(const std::string& name, const Place& place, const char* label, Diagnostics& diagnostics)
{
  if (name == "index" || name == "outcome" || name == "message") {
    diagnostics.add(place, fmt::format("{} = \"{}\" is a column of every study; expected another name", label, name));
    return false;
  }
  if (is_plain_name(name)) return true;
  diagnostics.add(
      place, fmt::format("{} = \"{}\" is no name of a column; expected letters, digits, '.', '_' or '-'", label, name));
  return false;
}

StudyFileResult parse_study(const std::string& text, const std::string& file)
{
  StudyFileResult result;
  StudyFile& study = result.value;
  study.file = file;
  study.text = text;
  auto parsed = config::parse_toml(text);
  if (const auto* error = std::get_if<config::SyntaxError>(&parsed)) {
    result.diagnostics.add(error->place, error->message);
    return result;
  }
  const Node& root = std::get<Node>(parsed);
  const std::vector<std::string> known = {"study", "set", "vary", "measure", "plot"};
  for (const auto& entry : root.table()->entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      result.diagnostics.add(entry.place,
                             fmt::format("a study has no '{}'{}", entry.key, config::suggestion(entry.key, known)));
  read_header(root, study, result.diagnostics);
  if (const auto* set = root.table()->find("set"); set != nullptr)
    study.settings = read_settings(set->value, "[set]", result.diagnostics);
  study.measures = read_measures(root, result.diagnostics);
  study.axes = read_axes(root, study.measures, result.diagnostics);
  std::vector<std::string> axis_names;
  for (const auto& axis : study.axes) axis_names.push_back(axis.name);
  study.plots = read_plots(root, axis_names, result.diagnostics);
  if (!result.diagnostics.empty()) return result;
  check_settings(study, result.diagnostics);
  check_columns(study, result.diagnostics);
  read_references(study, result.diagnostics);
  std::size_t n = 1;
  for (const auto& axis : study.axes) n = std::min(n * axis.points.size(), max_runs + 1); // without overflow
  if (n > max_runs)
    result.diagnostics.add(root.table()->find("vary")->place,
                           fmt::format("[[vary]] makes more than {} runs; expected fewer", max_runs));
  study.identity = identity_of(root, study.keep == "none");
  return result;
}

StudyFileResult read_study(const std::string& file)
{
  try {
    return parse_study(io::read_text(file), file);
  } catch (const Error& error) {
    StudyFileResult result;
    result.value.file = file;
    result.problem = error.what();
    return result;
  }
}

std::string difference(const StudyFile& there, const StudyFile& here)
{
  std::string text;
  const auto find = [](const auto& identity, const std::string& part) -> const std::string* {
    const auto found = std::find_if(identity.begin(), identity.end(), [&](const auto& p) { return p.first == part; });
    return found == identity.end() ? nullptr : &found->second;
  };
  for (const auto& [part, value] : there.identity) {
    const auto* other = find(here.identity, part);
    if (other == nullptr) text += fmt::format("\n  {}: there {}, here absent", part, value);
    else if (*other != value) text += fmt::format("\n  {}: there {}, here {}", part, value, *other);
  }
  for (const auto& [part, value] : here.identity)
    if (find(there.identity, part) == nullptr) text += fmt::format("\n  {}: there absent, here {}", part, value);
  return text;
}

} // namespace mullion::study
