#include "study/study_table.hpp"

#include "io/hdf5_image.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <limits>

namespace mullion::study {
namespace {

using Json = nlohmann::ordered_json;

std::string quoted_cell(const std::string& text)
{
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + '"';
}

/// The number in a cell; NaN if there is none.
double number_in(const std::string& cell)
{
  double value = 0.0;
  const auto parsed = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return parsed.ec == std::errc{} && parsed.ptr == cell.data() + cell.size() ? value
                                                                             : std::numeric_limits<double>::quiet_NaN();
}

/// Characters that a terminal shows: bytes that don't continue a UTF-8 sequence.
std::size_t width(const std::string& text)
{
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

std::string message_of(const RunResult& result)
{
  std::string text = result.message;
  for (const auto& problem : result.problems) text += (text.empty() ? "" : "; ") + problem;
  return text;
}

std::size_t count(std::span<const std::optional<RunResult>> results, std::string_view outcome)
{
  return static_cast<std::size_t>(
      std::count_if(results.begin(), results.end(), [&](const auto& r) { return r && r->outcome == outcome; }));
}

} // namespace

StudyTable make_table(const StudyFile& study, std::span<const std::optional<RunResult>> results)
{
  StudyTable table;
  table.push_back({"index", "index", "", "", "1", true, {}});
  for (const auto& axis : study.axes)
    for (std::size_t c = 0; c < axis.columns.size(); ++c)
      table.push_back({axis.columns[c], "axis", "", "", "", axis.is_numeric[c], {}});
  table.push_back({"outcome", "outcome", "", "", "", false, {}});
  const auto first_measure = table.size();
  for (const auto& measure : study.measures_of(0))
    for (const auto& column : columns_of(measure)) {
      const bool is_residual = column == measure.name + ".residual";
      table.push_back(
          {column, "measure", measure.kind, quantity_of(measure), is_residual ? "1" : unit_of(measure), true, {}});
    }
  table.push_back({"message", "message", "", "", "", false, {}});

  for (std::size_t r = 0; r < results.size(); ++r) {
    if (!results[r]) continue;
    const auto& result = *results[r];
    std::size_t c = 0;
    table[c++].cells.push_back(fmt::format("{}", r));
    for (const auto* point : study.points_of(r))
      for (const auto& cell : point->cells) table[c++].cells.push_back(cell);
    table[c++].cells.push_back(result.outcome);
    for (; c + 1 < table.size(); ++c) {
      const auto m = c - first_measure;
      const bool has_value = m < result.values.size() && result.values[m];
      table[c].cells.push_back(has_value ? fmt::format("{}", *result.values[m]) : "");
    }
    table[c].cells.push_back(message_of(result));
  }
  return table;
}

std::string csv_text(const StudyTable& table)
{
  std::string text;
  const auto write_line = [&](auto&& cell_of) {
    for (std::size_t c = 0; c < table.size(); ++c) (text += c == 0 ? "" : ",") += quoted_cell(cell_of(table[c]));
    text += '\n';
  };
  write_line([](const Column& column) { return column.name; });
  for (std::size_t r = 0; r < table[0].cells.size(); ++r)
    write_line([&](const Column& column) { return column.cells[r]; });
  return text;
}

io::Bytes hdf5_file(const StudyTable& table)
{
  io::ImageBuilder image;
  for (const auto& column : table) {
    auto path = "/" + column.name;
    std::replace(path.begin() + 1, path.end(), '/', '_'); // a quoted part of a key may have one
    if (column.is_numeric) {
      std::vector<double> values;
      for (const auto& cell : column.cells) values.push_back(number_in(cell));
      image.dataset(path, values.data(), {static_cast<std::int64_t>(values.size())});
    } else image.dataset(path, column.cells);
    image.attribute(path, "role", column.role);
    if (column.role == "measure") {
      image.attribute(path, "kind", column.kind);
      image.attribute(path, "quantity", column.quantity);
    }
    if (!column.unit.empty()) image.attribute(path, "unit", column.unit);
  }
  return image.finish();
}

std::string printed(const StudyTable& table, std::size_t max_rows)
{
  constexpr std::size_t widest_text = 60; // messages may be long; study.csv has them whole
  const auto n_rows = std::min(max_rows, table[0].cells.size());
  std::string text;
  std::vector<std::vector<std::string>> columns;
  for (const auto& column : table) {
    auto& cells = columns.emplace_back();
    cells.push_back(column.name);
    bool is_empty = true;
    for (std::size_t r = 0; r < n_rows; ++r) {
      auto cell = column.cells[r];
      if (column.is_numeric && !cell.empty()) cell = fmt::format("{:.6g}", number_in(cell));
      if (cell.size() > widest_text) cell = cell.substr(0, widest_text - 3) + "...";
      is_empty = is_empty && cell.empty();
      cells.push_back(std::move(cell));
    }
    if (is_empty && column.role == "message") columns.pop_back();
  }
  for (std::size_t r = 0; r <= n_rows; ++r) {
    std::string line;
    for (const auto& cells : columns) {
      std::size_t widest = 0;
      for (const auto& cell : cells) widest = std::max(widest, width(cell));
      (line += cells[r]).append(widest - width(cells[r]) + 2, ' ');
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  if (const auto rest = table[0].cells.size() - n_rows; rest > 0) text += fmt::format("… {} more\n", rest);
  return text;
}

std::string json_text(const StudyFile& study, std::span<const std::optional<RunResult>> results, double wall_s)
{
  Json json;
  json["name"] = study.name;
  json["case"] = study.case_file;
  json["axes"] = Json::array();
  for (const auto& axis : study.axes) {
    Json labels;
    if (axis.is_labelled) {
      labels = Json::array();
      for (const auto& point : axis.points) labels.push_back(point.cells[0]);
    }
    json["axes"].push_back({{"name", axis.name}, {"keys", axis.keys}, {"labels", labels}, {"columns", axis.columns}});
  }
  json["measures"] = Json::array();
  for (const auto& measure : study.measures_of(0))
    json["measures"].push_back({{"name", measure.name},
                                {"kind", measure.kind},
                                {"quantity", quantity_of(measure)},
                                {"unit", unit_of(measure)},
                                {"columns", columns_of(measure)}});
  json["plots"] = Json::array();
  for (const auto& plot : study.plots)
    json["plots"].push_back({{"title", plot.title},
                             {"factors", plot.factors()},
                             {"curves", plot.curves},
                             {"x_scale", plot.x_scale},
                             {"x_label", plot.x_label},
                             {"y_scale", plot.y_scale},
                             {"y_label", plot.y_label},
                             {"from", plot.from},
                             {"to", plot.to},
                             {"normalise", plot.normalise},
                             {"until", plot.until}});
  json["runs"] = results.size();
  json["completed"] = count(results, "completed");
  json["failed"] = count(results, "failed");
  json["stopped"] = count(results, "stopped");
  json["wall_s"] = wall_s;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace mullion::study
