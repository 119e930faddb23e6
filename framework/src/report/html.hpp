// Pieces of the page: texts made safe, tables, plots with their captions, and the page around them. The page is one
// file: its style and its plots stand in it, it loads nothing and runs nothing.
#pragma once

#include "report/gnuplot.hpp"
#include "report/picture.hpp"
#include "report/plot.hpp"

#include <string>
#include <vector>

namespace mullion::report {

/// A text from a file or a module as text of the page.
[[nodiscard]] std::string escape(const std::string& text);

struct Table {
  std::vector<std::string> header; ///< may be empty
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> classes{}; ///< of the rows, or none: "failed"
};

[[nodiscard]] std::string table_html(const Table& table);

/// gnuplot's document as an element of the page: without its prologue, entitled, its ids those of no other plot.
[[nodiscard]] std::string inline_svg(std::string svg, const std::string& name, const std::string& title);

/// Title, drawing, caption and where the files lie. A plot stands on the page as lines and texts, a picture, which has
/// thousands of cells, as the pixels of its PNG.
[[nodiscard]] std::string figure_html(const Plot& plot, const Drawing& drawing);
[[nodiscard]] std::string figure_html(const Picture& picture, const Drawing& drawing);

/// Bytes as text in base 64 (RFC 4648).
[[nodiscard]] std::string base64(const std::string& bytes);

[[nodiscard]] std::string page_html(const std::string& title, const std::string& body);

} // namespace mullion::report
