#include "report/page.hpp"

#include "io/atomic_file.hpp"
#include "report/gnuplot.hpp"
#include "report/html.hpp"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

/// Files of one name would replace each other: "velocity", "velocity-2", …
void make_names_unique(std::vector<Figure>& figures)
{
  std::set<std::string> taken;
  for (auto& figure : figures) {
    auto& name = std::visit([](auto& f) -> std::string& { return f.name; }, figure);
    const auto wanted = name;
    for (int n = 2; !taken.insert(name).second; ++n) name = fmt::format("{}-{}", wanted, n);
  }
}

void remove_old_plots(const fs::path& folder)
{
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".svg" || entry.path().extension() == ".png") fs::remove(entry.path(), ignored);
}

} // namespace

std::size_t write_page(const fs::path& folder, Page page)
{
  std::vector<Figure> figures;
  for (auto& piece : page.pieces)
    if (auto* figure = std::get_if<Figure>(&piece)) figures.push_back(std::move(*figure));
  make_names_unique(figures);
  const auto drawings = draw(figures);

  const auto out = folder / "report";
  io::make_folder(out / "plots");
  remove_old_plots(out / "plots");
  std::string body;
  std::size_t n = 0;
  for (const auto& piece : page.pieces) {
    if (const auto* html = std::get_if<Html>(&piece)) {
      body += html->text;
      continue;
    }
    const auto& drawing = drawings[n];
    std::visit(
        [&](const auto& figure) {
          body += figure_html(figure, drawing);
          if (!drawing.svg.empty()) io::write_atomically(out / "plots" / (figure.name + ".svg"), drawing.svg);
          io::write_atomically(out / "plots" / (figure.name + ".png"), drawing.png);
        },
        figures[n]);
    ++n;
  }
  io::write_atomically(out / "report.html", page_html(page.title, body));
  return figures.size();
}

} // namespace mullion::report
