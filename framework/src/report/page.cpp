#include "report/page.hpp"

#include "io/atomic_file.hpp"
#include "report/gnuplot.hpp"
#include "report/html.hpp"

#include <fmt/format.h>

#include <set>

namespace mullion::report {
namespace {

namespace fs = std::filesystem;

/// Files of one name would replace each other: "velocity", "velocity-2", …
void make_names_unique(std::vector<Plot>& plots)
{
  std::set<std::string> taken;
  for (auto& plot : plots) {
    const auto wanted = plot.name;
    for (int n = 2; !taken.insert(plot.name).second; ++n) plot.name = fmt::format("{}-{}", wanted, n);
  }
}

void remove_old_plots(const fs::path& folder)
{
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".svg" || entry.path().extension() == ".png") fs::remove(entry.path(), ignored);
}

} // namespace

std::size_t write_page(const fs::path& folder, const Page& page)
{
  std::vector<Plot> plots;
  for (const auto& piece : page.pieces)
    if (const auto* plot = std::get_if<Plot>(&piece)) plots.push_back(*plot);
  make_names_unique(plots);
  const auto drawings = draw(plots);

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
    body += figure_html(plots[n], drawings[n]);
    io::write_atomically(out / "plots" / (plots[n].name + ".svg"), drawings[n].svg);
    io::write_atomically(out / "plots" / (plots[n].name + ".png"), drawings[n].png);
    ++n;
  }
  io::write_atomically(out / "report.html", page_html(page.title, body));
  return plots.size();
}

} // namespace mullion::report
