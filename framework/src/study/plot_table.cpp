#include "study/plot_table.hpp"

#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_writer.hpp"

#include <mullion/sdk/parameters.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace mullion::study {
namespace {

struct PlotOptions : PlotSpec {
  static constexpr auto table()
  {
    using P = PlotOptions;
    return std::tuple{
        required_parameter("title", &P::title, "", "of the picture"),
        required_parameter("y", &P::y, "", "a column of history.csv, or a product of columns: \"a * b\""),
        parameter("x_scale", &P::x_scale, "1", "factor of the time", above(0.0)),
        parameter("x_label", &P::x_label, "", "of the time axis, with its unit"),
        parameter("y_scale", &P::y_scale, "1", "factor of y"),
        parameter("y_label", &P::y_label, "", "of the y axis, with its unit; default: y"),
        parameter("curves", &P::curves, "", "the axis that makes the curves of a picture; default: the last"),
        parameter("from", &P::from, "s", "earliest time", at_least(0.0)),
        parameter("to", &P::to, "s", "latest time; 0: the end", at_least(0.0)),
        parameter("normalise", &P::normalise, "",
                  "divide y by nothing, by its largest magnitude up to `until`, or by its first row after the start",
                  one_of("none", "largest", "first_row")),
        parameter("until", &P::until, "s", "for normalise = \"largest\"; 0: the end", at_least(0.0))};
  }
};

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(' '), last = text.find_last_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

} // namespace

std::vector<std::string> PlotSpec::factors() const
{
  std::vector<std::string> names;
  std::size_t begin = 0;
  for (std::size_t star = 0; star != std::string::npos; begin = star + 1) {
    star = y.find('*', begin);
    names.push_back(trimmed(y.substr(begin, star == std::string::npos ? star : star - begin)));
  }
  return names;
}

std::vector<PlotSpec> read_plots(const config::Node& root, const std::vector<std::string>& axes,
                                 config::Diagnostics& diagnostics)
{
  std::vector<PlotSpec> plots;
  const auto* entry = root.table()->find("plot");
  if (entry == nullptr) return plots;
  const auto* list = entry->value.list();
  if (list == nullptr) {
    diagnostics.add(entry->place, "'plot' is no list of tables; write [[plot]]");
    return plots;
  }
  for (const auto& node : *list) {
    if (node.table() == nullptr) {
      diagnostics.add(node.place, fmt::format("[[plot]] = {}; expected a table", config::describe(node)));
      continue;
    }
    const auto before = diagnostics.size();
    const auto values =
        config::read_parameters(node, {"[[plot]]", ""}, detail::parameter_specs<PlotOptions>(), {}, diagnostics);
    if (diagnostics.size() != before) continue;
    PlotSpec plot = detail::read_options<PlotOptions>(config::to_values(values).data());
    if (plot.y_label.empty()) plot.y_label = plot.y;
    if (plot.curves.empty() && !axes.empty()) plot.curves = axes.back();
    if (std::find(axes.begin(), axes.end(), plot.curves) == axes.end())
      diagnostics.add(node.table()->find("curves") == nullptr ? node.place : node.table()->find("curves")->value.place,
                      fmt::format("[[plot]] curves = \"{}\" is no axis of this study{}", plot.curves,
                                  config::suggestion(plot.curves, axes)));
    const auto factors = plot.factors();
    if (std::find(factors.begin(), factors.end(), "") != factors.end())
      diagnostics.add(
          node.table()->find("y")->value.place,
          fmt::format("[[plot]] y = \"{}\"; expected a column of history.csv, or columns with * between them", plot.y));
    plots.push_back(std::move(plot));
  }
  return plots;
}

} // namespace mullion::study
