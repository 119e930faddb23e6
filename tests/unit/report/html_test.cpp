// Texts from files and modules cannot break the page.
#include "report/html.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion::report;

namespace {
bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }
} // namespace

TEST_CASE("what HTML would take for its own is escaped")
{
  CHECK(escape("<b> & \"c\" 'd'") == "&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  CHECK(escape("ρ = 1.3") == "ρ = 1.3");
}

TEST_CASE("tables, titles and captions are escaped")
{
  const std::string evil = "</table><script>alert(1)</script>";
  Plot plot;
  plot.title = plot.caption = evil;

  const auto table = table_html({{evil}, {{evil}}, {evil}});
  const auto figure = figure_html(plot, {"<?xml?><!DOCTYPE x><svg><title>Gnuplot</title></svg>", ""});
  const auto page = page_html(evil, "");

  for (const auto& html : {table, figure, page}) {
    CHECK_FALSE(has(html, "<script>"));
    CHECK(has(html, "&lt;script&gt;"));
  }
}

TEST_CASE("columns of numbers stand at the right, those with a text and tables of facts at the left")
{
  const auto table = table_html({{"calls", "version", "wall"}, {{"12", "0.1.0", "1.5 ms"}, {"", "", "2 s"}}});

  CHECK(has(table, "<td class=\"number\">12</td><td>0.1.0</td><td class=\"number\">1.5 ms</td>"));
  CHECK(has(table_html({{}, {{"steps", "12"}}}), "<td>12</td>"));
}

TEST_CASE("a drawing becomes an element whose ids and title are its own")
{
  const auto svg = inline_svg("<?xml version=\"1.0\"?>\n<svg><title>Gnuplot</title><g id=\"p\"/><use href='#p'/></svg>",
                              "work", "a < b");

  CHECK(svg == "<svg><title>a &lt; b</title><g id=\"work-p\"/><use href='#work-p'/></svg>");
}
