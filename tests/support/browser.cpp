#include "support/browser.hpp"

#include "support/run_case.hpp"
#include "support/run_process.hpp"

#include <nlohmann/json.hpp>

#include <fstream>
#include <stdexcept>

namespace mullion::test {
namespace {

// Boxes of text are those of its lines, with the room for accents and descenders, so neighbours may overlap a little.
constexpr const char* measuring_script = R"html(<script>
window.addEventListener('load', () => {
  const problems = [];
  const page = document.documentElement;
  if (page.scrollWidth > page.clientWidth) problems.push(`page: ${page.scrollWidth} px in ${page.clientWidth}`);
  for (const element of document.querySelectorAll('h1, h2, h3, p, figure, figcaption, .error, .table, pre, svg')) {
    const box = element.getBoundingClientRect();
    if (box.right > page.clientWidth + 1 || box.left < -1)
      problems.push(`${element.tagName} beyond the page: ${element.textContent.trim().slice(0, 60)}`);
  }
  let n_texts = 0;
  for (const svg of document.querySelectorAll('svg')) {
    const frame = svg.getBoundingClientRect();
    const texts = [...svg.querySelectorAll('text')].map(t => [t.textContent.trim(), t.getBoundingClientRect()])
                                                   .filter(([text]) => text !== '');
    n_texts += texts.length;
    for (const [text, box] of texts)
      if (box.left < frame.left - 1 || box.right > frame.right + 1 || box.top < frame.top - 1 || box.bottom > frame.bottom + 1)
        problems.push(`cut off: ${text}`);
    for (const [i, [text, a]] of texts.entries())
      for (const [other, b] of texts.slice(i + 1)) {
        const across = Math.min(a.right, b.right) - Math.max(a.left, b.left);
        const down = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
        if (across > 1 && down > 0.3 * Math.min(a.height, b.height)) problems.push(`over each other: ${text} | ${other}`);
      }
  }
  const result = document.createElement('pre');
  result.id = 'looks';
  result.textContent = btoa(unescape(encodeURIComponent(JSON.stringify({
    plots: document.querySelectorAll('svg').length, texts: n_texts, problems: problems.join('\n'),
    loaded: performance.getEntriesByType('resource').length}))));
  document.body.append(result);
});
</script></body>)html";

/// What btoa() made of a text.
std::string from_base64(const std::string& text)
{
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  unsigned bits = 0;
  int n_bits = 0;
  for (const char c : text) {
    const auto value = alphabet.find(c);
    if (value == std::string::npos) continue; // the padding
    bits = (bits << 6) | static_cast<unsigned>(value);
    n_bits += 6;
    if (n_bits < 8) continue;
    n_bits -= 8;
    bytes += static_cast<char>((bits >> n_bits) & 0xff);
  }
  return bytes;
}

} // namespace

bool has_browser() { return run_process({"sh", "-c", "command -v chromium"}).exit_code == 0; }

PageLooks look_at(const std::filesystem::path& page, const std::filesystem::path& scratch)
{
  auto html = read_file(page);
  const auto end = html.rfind("</body>");
  if (end == std::string::npos) throw std::runtime_error(page.string() + " is no whole page");
  html.replace(end, std::string("</body>").size(), measuring_script);
  const auto copy = scratch / "measured.html";
  std::ofstream(copy) << html;
  const auto result = run_process(
      {"chromium", "--headless", "--no-sandbox", "--disable-gpu", "--disable-dev-shm-usage", "--no-first-run",
       "--user-data-dir=" + (scratch / "profile").string(), "--proxy-server=127.0.0.1:9", // nobody listens there
       "--host-resolver-rules=MAP * ~NOTFOUND", "--window-size=1200,4000", "--virtual-time-budget=5000", "--dump-dom",
       "file://" + std::filesystem::absolute(copy).string()},
      {.environment = {{"HOME", scratch.string()}}, .folder = scratch.string(), .timeout = std::chrono::seconds(60)});
  const std::string mark = "<pre id=\"looks\">";
  const auto begin = result.out.rfind(mark);
  if (result.exit_code != 0 || begin == std::string::npos)
    throw std::runtime_error("chromium did not measure " + page.string() + ": " + result.err);
  const auto text =
      result.out.substr(begin + mark.size(), result.out.find('<', begin + mark.size()) - begin - mark.size());
  const auto looks = nlohmann::json::parse(from_base64(text));
  return {looks.at("plots"), looks.at("texts"), looks.at("loaded"), looks.at("problems")};
}

} // namespace mullion::test
