// [[vary]] of a study file: values or a range of one key, values of several keys side by side, or labelled points.
#include "study/study_file.hpp"

#include "config/suggestions.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace mullion::study {
namespace {

using config::Diagnostics;
using config::List;
using config::Node;
using config::Table;

constexpr std::size_t max_points = 100'000; ///< of an axis: more is a slip of the pen

const Node* value_of(const Node& node, std::string_view key)
{
  const auto* entry = node.table()->find(key);
  return entry == nullptr ? nullptr : &entry->value;
}

void check_keys(const Node& node, const char* label, const std::vector<std::string>& known, Diagnostics& diagnostics)
{
  for (const auto& entry : node.table()->entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      diagnostics.add(entry.place,
                      fmt::format("{} knows no key '{}'{}", label, entry.key, config::suggestion(entry.key, known)));
}

std::optional<double> number_of(const Node& node)
{
  if (const auto* real = std::get_if<double>(&node.value)) return *real;
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*integer);
  return std::nullopt;
}

/// A cell of the table: a text without its quotes, anything else as TOML writes it.
std::string cell_of(const Node& value) { return value.text() != nullptr ? *value.text() : config::write_value(value); }

// ---- range -------------------------------------------------------------------------------------------------------

struct Range {
  double from = 0.0, to = 0.0;
  std::int64_t count = 0;
  bool is_logarithmic = false, is_integer = false;
};

/// Ends included, and met exactly.
double value_at(const Range& range, std::int64_t i)
{
  if (i == 0) return range.from;
  if (i + 1 == range.count) return range.to;
  const double share = static_cast<double>(i) / static_cast<double>(range.count - 1);
  return range.is_logarithmic ? range.from * std::pow(range.to / range.from, share)
                              : range.from + (range.to - range.from) * share;
}

std::optional<Range> read_range(const Node& node, Diagnostics& diagnostics)
{
  const auto before = diagnostics.size();
  if (node.table() == nullptr) {
    diagnostics.add(node.place, fmt::format("[[vary]] range = {}; expected {{ from = 0.1, to = 1.0, count = 10 }}",
                                            config::describe(node)));
    return std::nullopt;
  }
  check_keys(node, "[[vary]] range", {"from", "to", "count", "spacing"}, diagnostics);
  Range range;
  const auto take_number = [&](const char* key, double& out) {
    const Node* value = value_of(node, key);
    const auto number = value == nullptr ? std::nullopt : number_of(*value);
    if (number && std::isfinite(*number)) out = *number;
    else if (value == nullptr)
      diagnostics.add(node.place, fmt::format("[[vary]] range has no '{}'; expected a number", key));
    else
      diagnostics.add(value->place,
                      fmt::format("[[vary]] range {} = {}; expected a number", key, config::describe(*value)));
    return value != nullptr && std::get_if<std::int64_t>(&value->value) != nullptr;
  };
  const bool is_from_integer = take_number("from", range.from), is_to_integer = take_number("to", range.to);

  const Node* count = value_of(node, "count");
  const auto* n = count == nullptr ? nullptr : std::get_if<std::int64_t>(&count->value);
  if (n != nullptr && *n >= 2 && *n <= static_cast<std::int64_t>(max_points)) range.count = *n;
  else
    diagnostics.add(
        count == nullptr ? node.place : count->place,
        fmt::format("[[vary]] range {}; expected an integer in [2, {}]: how many values, both ends "
                    "included",
                    count == nullptr ? "has no 'count'" : fmt::format("count = {}", config::write_value(*count)),
                    max_points));

  if (const Node* spacing = value_of(node, "spacing"); spacing != nullptr) {
    const auto* text = spacing->text();
    range.is_logarithmic = text != nullptr && *text == "log";
    if (text == nullptr || (*text != "log" && *text != "linear"))
      diagnostics.add(spacing->place, fmt::format("[[vary]] range spacing = {}; expected \"linear\" or \"log\"",
                                                  config::write_value(*spacing)));
  }
  if (diagnostics.size() != before) return std::nullopt;
  if (range.is_logarithmic && !(range.from > 0.0 && range.to > 0.0)) {
    diagnostics.add(node.place, fmt::format("[[vary]] range from {} to {} cannot be spaced logarithmically; expected "
                                            "both ends above 0",
                                            range.from, range.to));
    return std::nullopt;
  }
  // whole numbers stay whole, where every one of them is: keys of integers take nothing else
  range.is_integer = is_from_integer && is_to_integer && !range.is_logarithmic &&
                     std::fmod(range.to - range.from, static_cast<double>(range.count - 1)) == 0.0;
  return range;
}

// ---- the three forms ---------------------------------------------------------------------------------------------

Point point_of(const std::vector<std::string>& keys, const std::vector<const Node*>& values)
{
  Point point;
  for (std::size_t k = 0; k < keys.size(); ++k) {
    point.cells.push_back(cell_of(*values[k]));
    point.settings.push_back({keys[k], config::write_value(*values[k]), values[k]->place});
  }
  return point;
}

/// The list behind `key`, not empty; else nothing and a diagnostic.
const List* read_list(const Node& node, const char* key, const char* wish, Diagnostics& diagnostics)
{
  const Node* value = value_of(node, key);
  const List* list = value == nullptr ? nullptr : value->list();
  if (value == nullptr) diagnostics.add(node.place, fmt::format("[[vary]] has no '{}'; expected {}", key, wish));
  else if (list == nullptr)
    diagnostics.add(value->place, fmt::format("[[vary]] {} = {}; expected {}", key, config::describe(*value), wish));
  else if (list->empty()) diagnostics.add(value->place, fmt::format("[[vary]] {} is empty; expected {}", key, wish));
  else if (list->size() > max_points)
    diagnostics.add(value->place,
                    fmt::format("[[vary]] {} has {} entries; expected at most {}", key, list->size(), max_points));
  else return list;
  return nullptr;
}

void mark_numbers(Axis& axis, const std::vector<std::vector<const Node*>>& rows)
{
  axis.is_numeric.assign(axis.columns.size(), true);
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c)
      if (!number_of(*row[c])) axis.is_numeric[c] = false;
}

void read_one_key(const Node& node, Axis& axis, Diagnostics& diagnostics)
{
  const Node& key = *value_of(node, "key");
  if (key.text() == nullptr) {
    diagnostics.add(key.place, fmt::format("[[vary]] key = {}; expected a key of the case as a text, say "
                                           "\"driver.omega\"",
                                           config::describe(key)));
    return;
  }
  if (!check_key(*key.text(), key.place, "[[vary]] key", diagnostics)) return;
  axis.name = *key.text();
  axis.keys = axis.columns = {axis.name};
  if (const Node* range_node = value_of(node, "range"); range_node != nullptr) {
    if (const Node* values = value_of(node, "values"); values != nullptr)
      diagnostics.add(values->place, "[[vary]] has both 'values' and 'range'; expected one of them");
    const auto range = read_range(*range_node, diagnostics);
    axis.is_numeric = {true};
    for (std::int64_t i = 0; range && i < range->count; ++i) {
      Node value{range_node->place, value_at(*range, i)};
      if (range->is_integer) value.value = static_cast<std::int64_t>(std::llround(value_at(*range, i)));
      axis.points.push_back(point_of(axis.keys, {&value}));
    }
    return;
  }
  const List* values = read_list(node, "values", "a list of values, or a range", diagnostics);
  if (values == nullptr) return;
  std::vector<std::vector<const Node*>> rows;
  for (const auto& value : *values) rows.push_back({&value});
  for (const auto& row : rows) axis.points.push_back(point_of(axis.keys, row));
  mark_numbers(axis, rows);
}

void read_zipped(const Node& node, Axis& axis, Diagnostics& diagnostics)
{
  const List* keys = read_list(node, "keys", "a list of keys of the case", diagnostics);
  const List* values = read_list(node, "values", "a list of lists, a value for each key", diagnostics);
  if (keys == nullptr) return;
  for (const auto& key : *keys) {
    if (key.text() == nullptr)
      diagnostics.add(key.place, fmt::format("[[vary]] keys: {}; expected a text", config::describe(key)));
    else if (check_key(*key.text(), key.place, "[[vary]] keys:", diagnostics)) axis.keys.push_back(*key.text());
  }
  if (axis.keys.size() != keys->size() || values == nullptr) return;
  axis.columns = axis.keys;
  axis.name = fmt::format("{}", fmt::join(axis.keys, ", "));
  std::vector<std::vector<const Node*>> rows;
  for (const auto& value : *values) {
    const List* row = value.list();
    if (row == nullptr || row->size() != axis.keys.size()) {
      diagnostics.add(value.place, fmt::format("[[vary]] values: {}; expected a list of {}, a value for each key",
                                               config::describe(value), axis.keys.size()));
      continue;
    }
    auto& cells = rows.emplace_back();
    for (const auto& cell : *row) cells.push_back(&cell);
    axis.points.push_back(point_of(axis.keys, cells));
  }
  mark_numbers(axis, rows);
}

void read_point(const Node& node, Axis& axis, const std::vector<MeasureSpec>& measures, Diagnostics& diagnostics)
{
  if (node.table() == nullptr) {
    diagnostics.add(node.place, fmt::format("[[vary]] points: {}; expected {{ label = \"…\", set = {{ \"key\" = value "
                                            "}} }}",
                                            config::describe(node)));
    return;
  }
  check_keys(node, "[[vary]] points", {"label", "set", "measure"}, diagnostics);
  Point point;
  const Node* label = value_of(node, "label");
  if (label == nullptr) diagnostics.add(node.place, "[[vary]] points: there is no 'label'; expected a text");
  else if (label->text() == nullptr)
    diagnostics.add(label->place, fmt::format("[[vary]] points label = {}; expected a text", config::describe(*label)));
  else if (std::any_of(axis.points.begin(), axis.points.end(),
                       [&](const Point& p) { return p.cells[0] == *label->text(); }))
    diagnostics.add(label->place,
                    fmt::format("[[vary]] points label = {} is there twice", config::write_value(*label)));
  point.cells = {label == nullptr ? "" : cell_of(*label)};

  if (const Node* set = value_of(node, "set"); set != nullptr)
    point.settings = read_settings(*set, "[[vary]] points set", diagnostics);
  for (const auto& setting : point.settings)
    if (std::find(axis.keys.begin(), axis.keys.end(), setting.key) == axis.keys.end()) axis.keys.push_back(setting.key);
  if (const Node* measure = value_of(node, "measure"); measure != nullptr)
    point.measure = read_point_measure(*measure, measures, diagnostics);
  axis.points.push_back(std::move(point));
}

void read_labelled(const Node& node, Axis& axis, const std::vector<MeasureSpec>& measures, Diagnostics& diagnostics)
{
  axis.is_labelled = true;
  axis.is_numeric = {false};
  const Node* name = value_of(node, "name");
  if (name == nullptr)
    diagnostics.add(node.place, "[[vary]] has 'points' but no 'name'; expected a text: column of study.csv");
  else if (name->text() == nullptr)
    diagnostics.add(name->place,
                    fmt::format("[[vary]] name = {}; expected a text: column of study.csv", config::describe(*name)));
  else if (check_column(*name->text(), name->place, "[[vary]] name", diagnostics)) axis.name = *name->text();
  axis.columns = {axis.name};
  const List* points = read_list(node, "points", "a list of { label = \"…\", set = { \"key\" = value } }", diagnostics);
  if (points == nullptr) return;
  for (const auto& point : *points) read_point(point, axis, measures, diagnostics);
}

Axis read_axis(const Node& node, const std::vector<MeasureSpec>& measures, Diagnostics& diagnostics)
{
  Axis axis;
  std::vector<std::string> forms;
  for (const char* form : {"key", "keys", "points"})
    if (value_of(node, form) != nullptr) forms.emplace_back(form);
  if (forms.size() == 1 && forms[0] == "key") {
    check_keys(node, "[[vary]] with 'key'", {"key", "values", "range"}, diagnostics);
    read_one_key(node, axis, diagnostics);
  } else if (forms.size() == 1 && forms[0] == "keys") {
    check_keys(node, "[[vary]] with 'keys'", {"keys", "values"}, diagnostics);
    read_zipped(node, axis, diagnostics);
  } else if (forms.size() == 1) {
    check_keys(node, "[[vary]] with 'points'", {"name", "points"}, diagnostics);
    read_labelled(node, axis, measures, diagnostics);
  } else {
    check_keys(node, "[[vary]]", {"key", "keys", "name", "points", "values", "range"}, diagnostics);
    diagnostics.add(node.place, fmt::format("[[vary]] has {}; expected one of 'key' (with values or a range), 'keys' "
                                            "(with values) and 'points' (with a name)",
                                            forms.empty() ? "nothing that varies"
                                                          : fmt::format("'{}'", fmt::join(forms, "' and '"))));
  }
  return axis;
}

} // namespace

std::vector<Axis> read_axes(const Node& root, const std::vector<MeasureSpec>& measures, Diagnostics& diagnostics)
{
  std::vector<Axis> axes;
  const auto* entry = root.table()->find("vary");
  if (entry == nullptr) return axes;
  const List* list = entry->value.list();
  if (list == nullptr ||
      std::any_of(list->begin(), list->end(), [](const Node& element) { return element.table() == nullptr; })) {
    diagnostics.add(entry->place, "'vary' is no list of tables; write [[vary]] for each axis");
    return axes;
  }
  for (const auto& node : *list) {
    auto axis = read_axis(node, measures, diagnostics);
    for (const auto& other : axes)
      for (const auto& key : axis.keys)
        if (std::find(other.keys.begin(), other.keys.end(), key) != other.keys.end())
          diagnostics.add(node.place, fmt::format("[[vary]] sets '{}', which an axis before it sets too", key));
    axes.push_back(std::move(axis));
  }
  return axes;
}

} // namespace mullion::study
