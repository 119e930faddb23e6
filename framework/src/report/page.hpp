// A report before it is drawn: pieces of the page in their order, texts, plots and pictures. run_page() and
// study_page() make one from files; write_page() draws the plots and writes the folder `report/`.
#pragma once

#include "report/gnuplot.hpp"

#include <cstddef>
#include <filesystem>
#include <string>
#include <variant>
#include <vector>

namespace mullion::report {

/// Text of the page, safe already.
struct Html {
  std::string text;
};

struct Page {
  std::string title;
  std::vector<std::variant<Html, Figure>> pieces;

  void add(std::string html) { pieces.emplace_back(Html{std::move(html)}); }
  void add(Figure figure) { pieces.emplace_back(std::move(figure)); }
};

/// The page about a run's folder. Whatever of its results, history.csv and case.toml is missing, the page says so.
/// @throws Error Errc::io: run.json, history.csv or a file of the results cannot be read
[[nodiscard]] Page run_page(const std::filesystem::path& folder);

/// The page about a study's folder.
/// @throws Error Errc::io: study.json or study.csv cannot be read
[[nodiscard]] Page study_page(const std::filesystem::path& folder);

/// Draw the plots and write `folder`/report/report.html and report/plots/; plots of an earlier report go.
/// @return the number of plots and pictures
/// @throws Error Errc::process: gnuplot is missing or failed; Errc::io
std::size_t write_page(const std::filesystem::path& folder, Page page);

} // namespace mullion::report
