#include "study/measure_table.hpp"

#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_writer.hpp"
#include "io/atomic_file.hpp"

#include <mullion/sdk/parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <tuple>

namespace mullion::study {
namespace {

/// Every key of every kind, declared once.
struct MeasureOptions {
  std::string name, kind, quantity, unit, file, time_column, value_column, norm = "max", relative_to;
  double scale = 1.0, from = 0.0, to = 0.0, window = 0.0, offset = 0.0, above = 0.0, time_scale = 1.0;
  static constexpr auto table()
  {
    using M = MeasureOptions;
    return std::tuple{
        required_parameter("name", &M::name, "", "column of study.csv"),
        required_parameter("kind", &M::kind, "", "what is measured"),
        required_parameter("quantity", &M::quantity, "", "a column of history.csv"),
        parameter("scale", &M::scale, "1", "factor of the result; of a reference_error: what it is divided by"),
        parameter("unit", &M::unit, "", "unit of the result, for tables and plots"),
        parameter("from", &M::from, "s", "earliest time that counts"),
        parameter("to", &M::to, "s", "latest time that counts"),
        required_parameter("window", &M::window, "s", "length of a window", above_zero()),
        parameter("offset", &M::offset, "", "what deviations are from, in the quantity's unit"),
        required_parameter("above", &M::above, "", "the magnitude to exceed, in the quantity's unit", at_least(0.0)),
        required_parameter("file", &M::file, "", "CSV file of the reference, relative to the study file"),
        required_parameter("time_column", &M::time_column, "", "its column of times"),
        required_parameter("value_column", &M::value_column, "", "its column of values"),
        parameter("time_scale", &M::time_scale, "s", "what one unit of its times is", above_zero()),
        parameter("norm", &M::norm, "", "largest error or root of the mean square", one_of("max", "rms")),
        parameter("relative_to", &M::relative_to, "",
                  "a column of history.csv, whose largest magnitude the drift is divided by")};
  }
  static constexpr Range above_zero() { return mullion::above(0.0); }
};

struct Kind {
  std::string_view name, keys; ///< besides name, kind, unit, scale, from and to
};

constexpr Kind kinds[] = {{"growth_rate", "quantity"},
                          {"envelope_rate", "quantity window"},
                          {"error_doubling", "quantity window offset"},
                          {"dominant_frequency", "quantity"},
                          {"two_frequencies", "quantity"},
                          {"amplitude", "quantity"},
                          {"maximum", "quantity"},
                          {"last", "quantity"},
                          {"mean", "quantity"},
                          {"sum", "quantity"},
                          {"ratio", "quantity window"},
                          {"first_time", "quantity above"},
                          {"reference_error", "quantity file time_column value_column time_scale norm"},
                          {"drift", "relative_to"},
                          {"iterations", "quantity"},
                          {"function", "quantity"},
                          {"wall_time", ""},
                          {"steps", ""}};

constexpr const char* default_iterations = "driver.iterations";

bool takes(const Kind& kind, std::string_view key)
{
  if (key == "name" || key == "kind" || key == "unit" || key == "scale") return true;
  if (key == "from" || key == "to")
    return kind.name != "wall_time" && kind.name != "steps" && kind.name != "function"; // of the whole run
  for (auto rest = kind.keys; !rest.empty();) {
    const auto end = std::min(rest.find(' '), rest.size());
    if (rest.substr(0, end) == key) return true;
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return false;
}

std::vector<mullion_parameter_spec> specs_of(const Kind& kind)
{
  std::vector<mullion_parameter_spec> specs;
  for (auto spec : detail::parameter_specs<MeasureOptions>()) {
    if (!takes(kind, spec.name)) continue;
    if (kind.name == "iterations" && std::string_view(spec.name) == "quantity") {
      spec.is_required = 0;
      spec.default_text = default_iterations;
    }
    specs.push_back(spec);
  }
  return specs;
}

const Kind* find_kind(std::string_view name)
{
  const auto* const found =
      std::find_if(std::begin(kinds), std::end(kinds), [&](const Kind& kind) { return kind.name == name; });
  return found == std::end(kinds) ? nullptr : found;
}

/// The kind of a measure's table, or nothing and a diagnostic.
const Kind* read_kind(const config::Node& node, config::Diagnostics& diagnostics)
{
  std::vector<std::string> known;
  for (const auto& kind : kinds) known.emplace_back(kind.name);
  const auto* entry = node.table()->find("kind");
  if (entry == nullptr) {
    diagnostics.add(node.place, fmt::format("[[measure]] has no 'kind'; expected one of {}", fmt::join(known, ", ")));
    return nullptr;
  }
  const auto* text = entry->value.text();
  const Kind* kind = text == nullptr ? nullptr : find_kind(*text);
  if (kind != nullptr) return kind;
  const auto near = text == nullptr ? "" : config::nearest_name(*text, known);
  diagnostics.add(entry->value.place,
                  fmt::format("[[measure]] kind = {} is no kind of measure; {}", config::write_value(entry->value),
                              near.empty() ? fmt::format("expected one of {}", fmt::join(known, ", "))
                                           : fmt::format("did you mean '{}'?", near)));
  return nullptr;
}

void read_terms(const config::Node& node, MeasureSpec& measure, config::Diagnostics& diagnostics)
{
  const auto* entry = node.table()->find("terms");
  const char* const wish = "expected { \"column of history.csv\" = factor, … }";
  if (entry == nullptr) {
    diagnostics.add(node.place, fmt::format("[[measure]] has no 'terms'; {}", wish));
    return;
  }
  const auto* table = entry->value.table();
  if (table == nullptr || table->entries.empty()) {
    diagnostics.add(entry->value.place,
                    fmt::format("[[measure]] terms = {}; {}", config::describe(entry->value), wish));
    return;
  }
  for (const auto& term : table->entries) {
    const auto* real = std::get_if<double>(&term.value.value);
    const auto* integer = std::get_if<std::int64_t>(&term.value.value);
    if (real == nullptr && integer == nullptr)
      diagnostics.add(term.value.place, fmt::format("[[measure]] terms \"{}\" = {}; expected a factor", term.key,
                                                    config::describe(term.value)));
    else measure.terms.emplace_back(term.key, real != nullptr ? *real : static_cast<double>(*integer));
  }
}

const ParameterValue* find(const std::vector<ParameterValue>& parameters, std::string_view name)
{
  const auto found =
      std::find_if(parameters.begin(), parameters.end(), [&](const auto& value) { return value.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

} // namespace

std::string text_of(const std::vector<ParameterValue>& parameters, const std::string& name)
{
  const auto* value = find(parameters, name);
  const auto* text = value == nullptr ? nullptr : std::get_if<std::string>(&value->value);
  return text == nullptr ? "" : *text;
}

config::Place place_of(const MeasureSpec& measure, const std::string& key)
{
  const auto* table = measure.node.table();
  const auto* entry = table == nullptr ? nullptr : table->find(key);
  return entry == nullptr ? measure.node.place : entry->value.place;
}

std::vector<MeasureSpec> read_measures(const config::Node& root, config::Diagnostics& diagnostics)
{
  std::vector<MeasureSpec> measures;
  const auto* entry = root.table()->find("measure");
  if (entry == nullptr) return measures;
  const auto* list = entry->value.list();
  if (list == nullptr ||
      std::any_of(list->begin(), list->end(), [](const auto& element) { return element.table() == nullptr; })) {
    diagnostics.add(entry->place, "'measure' is no list of tables; write [[measure]] for each number to take");
    return measures;
  }
  for (const auto& node : *list) {
    const Kind* kind = read_kind(node, diagnostics);
    if (kind == nullptr) continue;
    MeasureSpec measure;
    const bool has_terms = kind->name == "drift";
    measure.parameters = config::read_parameters(
        node, {"[[measure]]", ""}, specs_of(*kind),
        has_terms ? std::vector<std::string>{"terms"} : std::vector<std::string>{}, diagnostics);
    if (has_terms) read_terms(node, measure, diagnostics);
    measure.name = text_of(measure.parameters, "name");
    measure.kind = kind->name;
    measure.node = node;
    measures.push_back(std::move(measure));
  }
  return measures;
}

std::vector<ParameterValue> read_point_measure(const config::Node& node, const std::vector<MeasureSpec>& measures,
                                               config::Diagnostics& diagnostics)
{
  if (node.table() == nullptr) {
    diagnostics.add(node.place, fmt::format("[[vary]] measure = {}; expected {{ from = 0.1, … }}: parameters of the "
                                            "measures at this point",
                                            config::describe(node)));
    return {};
  }
  std::vector<mullion_parameter_spec> specs; // what a measure of this study takes and what can differ from run to run
  for (auto spec : detail::parameter_specs<MeasureOptions>()) {
    const std::string_view key = spec.name;
    if (key == "name" || key == "kind" || key == "quantity" || key == "unit") continue;
    if (std::none_of(measures.begin(), measures.end(),
                     [&](const MeasureSpec& m) { return find(m.parameters, key) != nullptr; }))
      continue;
    spec.is_required = 0;
    specs.push_back(spec);
  }
  auto values = config::read_parameters(node, {"[[vary]] measure", ""}, specs, {}, diagnostics);
  std::erase_if(values, [](const auto& value) { return !value.is_given; });
  return values;
}

Measure make_measure(const MeasureSpec& spec, std::span<const std::vector<ParameterValue>* const> of_points,
                     const References& references)
{
  auto parameters = spec.parameters;
  for (const auto* point : of_points)
    for (const auto& value : *point)
      for (auto& parameter : parameters)
        if (parameter.name == value.name) parameter = value;

  Measure m;
  m.name = spec.name;
  m.kind = spec.kind;
  m.terms = spec.terms;
  m.quantity = text_of(parameters, "quantity");
  m.unit = text_of(parameters, "unit");
  m.relative_to = text_of(parameters, "relative_to");
  if (const auto norm = text_of(parameters, "norm"); !norm.empty()) m.norm = norm;
  const auto number = [&](std::string_view key, auto& member) {
    const auto* value = find(parameters, key);
    if (value != nullptr && value->is_given) member = std::get<double>(value->value);
  };
  number("scale", m.scale);
  number("from", m.from);
  number("to", m.to);
  number("window", m.window);
  number("offset", m.offset);
  number("above", m.above);
  if (const auto reference = references.find(text_of(parameters, "file")); reference != references.end()) {
    double time_scale = 1.0;
    number("time_scale", time_scale);
    m.reference_times = reference->second.column(text_of(parameters, "time_column"));
    for (double& t : m.reference_times) t *= time_scale;
    m.reference_values = reference->second.column(text_of(parameters, "value_column"));
  }
  return m;
}

std::string definition_of(const Measure& m)
{
  const auto checksum = [](const std::vector<double>& values) { return io::crc64(std::as_bytes(std::span(values))); };
  std::string text =
      fmt::format("{} {} {} {} {} {} {} {} {} {} {} {:x} {:x}", m.name, m.kind, m.quantity, m.scale, m.from, m.to,
                  m.window, m.above, m.norm, m.relative_to, m.offset ? fmt::format("{}", *m.offset) : "-",
                  checksum(m.reference_times), checksum(m.reference_values));
  for (const auto& [column, factor] : m.terms) text += fmt::format(" {}*{}", factor, column);
  return text;
}

} // namespace mullion::study
