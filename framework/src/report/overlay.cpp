#include "report/overlay.hpp"

#include "report/decimate.hpp"
#include "report/html.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <map>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t n_buckets = 450; // a picture has several curves; a bucket keeps four points

struct Series {
  std::vector<double> x, y;
};

/// The product of the columns over the scaled time, normalised as the plot says.
Series series_of(const nlohmann::json& plot, const CsvTable& history, const std::string& file)
{
  const auto column = [&](const std::string& name) -> const std::vector<double>& {
    const auto* found = history.find(name);
    MULLION_REQUIRE(found != nullptr && !found->is_text(), Errc::io, "{} has no column '{}' of numbers", file, name);
    return found->numbers;
  };
  const double from = plot.at("from"), until = plot.at("until");
  const double to = plot.at("to").get<double>() > 0.0 ? plot.at("to").get<double>() : INFINITY;
  const std::string normalise = plot.at("normalise");
  const auto& time = column("time");
  std::vector<double> y(time.size(), plot.at("y_scale").get<double>());
  for (const auto& factor : plot.at("factors"))
    for (std::size_t i = 0; const double value : column(factor.get<std::string>())) y[i++] *= value;

  double unit = 1.0;
  if (normalise == "first_row" && y.size() > 1) unit = std::abs(y[1]);
  if (normalise == "largest") {
    unit = 0.0;
    for (std::size_t i = 0; i < y.size(); ++i)
      if (until <= 0.0 || time[i] <= until) unit = std::max(unit, std::abs(y[i]));
  }
  Series series;
  for (std::size_t i = 0; i < y.size(); ++i) {
    if (time[i] < from || time[i] > to) continue;
    series.x.push_back(time[i] * plot.at("x_scale").get<double>());
    series.y.push_back(unit > 0.0 ? y[i] / unit : y[i]);
  }
  return series;
}

std::string cell(const CsvColumn& column, std::size_t row)
{
  return column.is_text() ? column.texts[row] : fmt::format("{} = {:.6g}", column.name, column.numbers[row]);
}

} // namespace

void add_overlay(Page& page, const fs::path& folder, const nlohmann::json& plot, const CsvTable& table,
                 const std::vector<const CsvColumn*>& axes, std::size_t curves)
{
  struct Picture {
    Plot plot;
    std::string missing;
    bool is_thinned = false;
  };
  std::vector<Picture> pictures;
  std::map<std::string, std::size_t> known;
  const auto* index = table.find("index");
  const std::string title = plot.at("title");
  for (std::size_t row = 0; row < table.n_rows; ++row) {
    std::string rest;
    for (std::size_t a = 0; a < axes.size(); ++a) {
      if (a == curves) continue;
      rest += rest.empty() ? "" : ", ";
      rest += axes[a]->is_text() ? fmt::format("{} = {}", axes[a]->name, axes[a]->texts[row]) : cell(*axes[a], row);
    }
    const auto [entry, is_new] = known.try_emplace(rest, pictures.size());
    if (is_new) {
      auto& fresh = pictures.emplace_back().plot;
      fresh.name = file_name(title + (rest.empty() ? "" : "-" + rest));
      fresh.title = rest.empty() ? title : fmt::format("{}, {}", title, rest);
      fresh.shape = Shape::lines;
      fresh.x = {plot.at("x_label").get<std::string>(), false};
      fresh.y = {plot.at("y_label").get<std::string>(), false};
    }
    auto& picture = pictures[entry->second];
    const auto run = fmt::format("{:.0f}", index == nullptr ? static_cast<double>(row) : index->numbers[row]);
    const auto name = axes.empty() ? "run " + run : cell(*axes[curves], row);
    const auto file = folder / "runs" / run / "history.csv";
    if (!fs::exists(file) || fs::file_size(file) == 0) {
      picture.missing += fmt::format(" {} has no history.", name);
      continue;
    }
    const auto series = series_of(plot, read_csv(file, LastLine::may_be_cut), file.string());
    auto& curve = picture.plot.curves.emplace_back();
    curve.title = name;
    curve.style = static_cast<int>(picture.plot.curves.size()) - 1;
    for (const auto i : decimate(series.x, series.y, n_buckets)) {
      curve.x.push_back(series.x[i]);
      curve.y.push_back(series.y[i]);
    }
    picture.is_thinned = picture.is_thinned || curve.x.size() < series.x.size();
  }
  for (auto& picture : pictures) {
    if (picture.plot.curves.empty()) {
      page.add(fmt::format("<p>{}: no run kept its history.</p>\n", escape(picture.plot.title)));
      continue;
    }
    if (picture.is_thinned)
      picture.plot.caption =
          fmt::format("Thinned out for the drawing: of each of {} equal intervals of time the first, "
                      "smallest, largest and last value.",
                      n_buckets);
    picture.plot.caption += picture.missing;
    page.add(std::move(picture.plot));
  }
}

} // namespace mullion::report
