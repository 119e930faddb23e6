// The documents hang together: links lead somewhere, cited papers are in the bibliography, code in them is the code.
#include "architecture/source_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

namespace fs = std::filesystem;

/// All matches of the pattern's first group.
std::vector<std::string> matches(const std::string& text, const std::string& pattern)
{
  const std::regex regex(pattern);
  std::vector<std::string> found;
  for (auto it = std::sregex_iterator(text.begin(), text.end(), regex); it != std::sregex_iterator(); ++it)
    found.push_back((*it)[1]);
  return found;
}

/// The heading as the anchor that a browser of repositories makes of it.
std::string anchor_of(const std::string& heading)
{
  std::string anchor;
  for (const char c : heading) {
    if (c == ' ') anchor += '-';
    else if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || (c & 0x80) != 0)
      anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  return anchor;
}

bool has_anchor(const fs::path& file, const std::string& anchor)
{
  for (const auto& line : lines_of(fs::relative(file, source_root()).string()))
    if (line.rfind('#', 0) == 0 &&
        anchor_of(line.substr(std::min(line.find_first_not_of('#') + 1, line.size()))) == anchor)
      return true;
  return false;
}

} // namespace

TEST_CASE("links in the documents lead to files and headings that exist")
{
  const auto documents = files_under(".", {".md"});
  REQUIRE(documents.size() > 10);
  for (const auto& document : documents)
    for (const auto& link : matches(text_of(document), R"re(\]\(([^)\s]+)\))re")) {
      if (link.rfind("http", 0) == 0) continue;
      const auto hash = link.find('#');
      const auto target = hash == 0 ? source_root() / document
                                    : source_root() / fs::path(document).parent_path() / link.substr(0, hash);
      CHECK_MESSAGE(fs::exists(target), document, " links to ", link);
      if (hash != std::string::npos && fs::exists(target))
        CHECK_MESSAGE(has_anchor(fs::canonical(target), link.substr(hash + 1)), document, " links to ", link);
    }
}

TEST_CASE("documents, tests and scripts that a text names exist")
{
  auto files = files_under(".", {".md"});
  for (const char* root : {"framework", "modules", "drivers", "examples"})
    for (const auto& file : sources_under(root)) files.push_back(file);
  for (const auto& file : files)
    for (const auto& name :
         matches(text_of(file),
                 R"re(\b((?:docs|tests|configs|scripts|framework|examples)/[\w/]*\w\.(?:md|hpp|h|cpp|sh|toml))\b)re"))
      CHECK_MESSAGE(fs::exists(source_root() / name), file, " names ", name);
}

TEST_CASE("papers that a text cites are in the bibliography")
{
  const auto known = matches(text_of("docs/references.bib"), R"re(@\w+\{(\w+),)re");
  REQUIRE(!known.empty());
  for (const auto& document : files_under(".", {".md"}))
    for (const auto& key : matches(text_of(document), R"re(`([a-z]+(?:19|20)\d\d[a-z]?)`)re"))
      CHECK_MESSAGE(std::find(known.begin(), known.end(), key) != known.end(), document, " cites ", key);
}

TEST_CASE("files that a document shows are those in the tree")
{
  int n_shown = 0;
  for (const auto& document : files_under("docs", {".md"})) {
    const auto lines = lines_of(document);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const auto file = matches(lines[i], R"re(^```\w+ file=(\S+/\S+)$)re");
      if (file.empty()) continue;
      ++n_shown;
      std::string shown;
      while (++i < lines.size() && lines[i] != "```") shown += lines[i] + "\n";
      CHECK_MESSAGE(shown == text_of(file[0]), document, " shows another ", file[0], " than there is");
    }
  }
  CHECK(n_shown >= 4);
}
