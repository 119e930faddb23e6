#include "report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>

namespace mullion::report {
namespace {

constexpr const char* style_sheet = R"(
body { font: 15px/1.45 sans-serif; color: #1a1a1a; background: #fff; max-width: 960px; margin: 1.5em auto; padding: 0 1em; }
h1 { font-size: 1.7em; margin: 0 0 .3em; overflow-wrap: anywhere; }
h2 { font-size: 1.25em; margin: 1.8em 0 .5em; border-bottom: 1px solid #ccc; }
.outcome { display: inline-block; padding: .1em .7em; border: 2px solid #009E73; font-weight: bold; }
.outcome.running { border-color: #0072B2; }
.outcome.stopped { border-color: #E69F00; }
.outcome.failed { border-color: #D55E00; }
.error { border-left: 5px solid #D55E00; background: #fdf3ec; padding: .6em 1em; white-space: pre-wrap; overflow-wrap: anywhere; font-family: monospace; }
.table { overflow-x: auto; }
table { border-collapse: collapse; margin: .5em 0; }
th, td { text-align: left; vertical-align: top; padding: .2em .9em .2em 0; border-bottom: 1px solid #e4e4e4; overflow-wrap: break-word; }
td.number, th.number { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
tr.failed td { background: #fdf3ec; }
figure { margin: 1.2em 0 1.8em; break-inside: avoid; }
figure h3 { font-size: 1em; margin: 0 0 .3em; overflow-wrap: anywhere; }
figure svg { display: block; width: 100%; height: auto; }
figure img { display: block; max-width: 100%; height: auto; }
figcaption { font-size: .87em; color: #444; overflow-wrap: anywhere; }
pre { background: #f6f6f6; padding: .8em; overflow-x: auto; }
a { color: #0072B2; }
@media print { body { max-width: none; margin: 0; } .table, pre { overflow: visible; } pre { white-space: pre-wrap; } }
)";

void replace_all(std::string& text, const std::string& from, const std::string& to)
{
  for (auto at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

/// "12", or "51.3 ms": to be aligned at the right.
bool is_number(const std::string& text)
{
  const auto* end = text.data() + std::min(text.find(' '), text.size());
  double value = 0.0;
  const auto parsed = std::from_chars(text.data(), end, value);
  return parsed.ec == std::errc{} && parsed.ptr == end;
}

/// Whether each cell of the column is a number or empty, and not all are empty.
bool is_number_column(const Table& table, std::size_t column)
{
  bool is_any = false;
  for (const auto& row : table.rows) {
    if (column >= row.size() || row[column].empty()) continue;
    if (!is_number(row[column])) return false;
    is_any = true;
  }
  return is_any;
}

} // namespace

std::string escape(const std::string& text)
{
  std::string safe;
  for (const char c : text) {
    switch (c) {
    case '&': safe += "&amp;"; break;
    case '<': safe += "&lt;"; break;
    case '>': safe += "&gt;"; break;
    case '"': safe += "&quot;"; break;
    case '\'': safe += "&#39;"; break;
    default: safe += c;
    }
  }
  return safe;
}

std::string table_html(const Table& table)
{
  std::string html = "<div class=\"table\"><table>\n";
  std::vector<std::string>
      attributes; // of the columns; a table without a header is of names and values, all at the left
  for (std::size_t c = 0; c < table.header.size(); ++c)
    attributes.emplace_back(is_number_column(table, c) ? " class=\"number\"" : "");
  if (!table.header.empty()) {
    html += "<tr>";
    for (std::size_t c = 0; c < table.header.size(); ++c)
      html += fmt::format("<th{}>{}</th>", attributes[c], escape(table.header[c]));
    html += "</tr>\n";
  }
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    const bool is_marked = r < table.classes.size() && !table.classes[r].empty();
    html += is_marked ? fmt::format("<tr class=\"{}\">", escape(table.classes[r])) : "<tr>";
    for (std::size_t c = 0; c < table.rows[r].size(); ++c)
      html += fmt::format("<td{}>{}</td>", c < attributes.size() ? attributes[c] : "", escape(table.rows[r][c]));
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string inline_svg(std::string svg, const std::string& name, const std::string& title)
{
  if (const auto begin = svg.find("<svg"); begin != std::string::npos) svg.erase(0, begin);
  // gnuplot's ids are the same in each of its drawings; the references to them are of these two forms
  for (const char* mark : {"id=\"", "id='", "href=\"#", "href='#", "url(#"}) replace_all(svg, mark, mark + name + "-");
  if (const auto begin = svg.find("<title>"), end = svg.find("</title>"); begin < end && end != std::string::npos)
    svg.replace(begin, end - begin, "<title>" + escape(title));
  return svg;
}

std::string base64(const std::string& bytes)
{
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve(4 * (bytes.size() / 3 + 1));
  for (std::size_t i = 0; i < bytes.size(); i += 3) { // three bytes are four digits
    std::uint32_t group = 0;
    for (std::size_t b = 0; b < 3; ++b)
      group = (group << 8) | (i + b < bytes.size() ? static_cast<unsigned char>(bytes[i + b]) : 0U);
    const auto n_bytes = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t d = 0; d < 4; ++d) text += d <= n_bytes ? digits[(group >> (18 - 6 * d)) & 63U] : '=';
  }
  return text;
}

std::string figure_html(const Plot& plot, const Drawing& drawing)
{
  return fmt::format("<figure><h3>{0}</h3>\n{1}\n<figcaption>{2}{3}<a href=\"plots/{4}.svg\">{4}.svg</a>, "
                     "<a href=\"plots/{4}.png\">{4}.png</a></figcaption></figure>\n",
                     escape(plot.title), inline_svg(drawing.svg, plot.name, plot.title), escape(plot.caption),
                     plot.caption.empty() ? "" : " ", escape(plot.name));
}

std::string figure_html(const Picture& picture, const Drawing& drawing)
{
  const auto name = escape(picture.name), title = escape(picture.title);
  const auto svg = drawing.svg.empty() ? "" : fmt::format("<a href=\"plots/{0}.svg\">{0}.svg</a>, ", name);
  return fmt::format("<figure><h3>{0}</h3>\n<img alt=\"{0}\" src=\"data:image/png;base64,{1}\">\n"
                     "<figcaption>{2}{3}{4}<a href=\"plots/{5}.png\">{5}.png</a></figcaption></figure>\n",
                     title, base64(drawing.png), escape(picture.caption), picture.caption.empty() ? "" : " ", svg,
                     name);
}

std::string page_html(const std::string& title, const std::string& body)
{
  return fmt::format("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                     "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{}</title>\n"
                     "<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
                     escape(title), style_sheet, body);
}

} // namespace mullion::report
