// Damaged case files: whatever is changed in one, bytes or whole words, it is a list of mistakes with places, or a case
// that reads back from its own text.
#include "config/toml_reader.hpp"
#include "mutations.hpp"

#include <mullion/app/case_file.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

using namespace mullion;
using namespace mullion::testing;

namespace {

/// The repository's cases, right ones and broken ones.
std::vector<std::string> sample_cases()
{
  namespace fs = std::filesystem;
  std::vector<fs::path> files;
  for (const char* folder : {"/configs", "/configs/paper", "/tests/cli/broken_cases"})
    for (const auto& entry : fs::directory_iterator(std::string(MULLION_SOURCE_DIR) + folder))
      if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<std::string> texts;
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    texts.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return texts;
}

std::vector<std::string> lines_of(const std::string& text)
{
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const auto end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

std::string repeated(const char* part, std::size_t n)
{
  std::string text;
  for (; n > 0; --n) text += part;
  return text;
}

const char* const odd_values[] = {"1e400",
                                  "-1e400",
                                  "-0",
                                  "-0.0",
                                  "nan",
                                  "-inf",
                                  "\"\"",
                                  "5e-324",
                                  "1.7976931348623157e308",
                                  "9223372036854775807",
                                  "-9223372036854775808",
                                  "9223372036854775808",
                                  "0x7fffffff",
                                  "2147483648",
                                  "-1",
                                  "0",
                                  "true",
                                  "[]",
                                  "{}",
                                  "[[]]",
                                  "[[\"\", \"\"]]",
                                  "1979-05-27T07:32:00Z",
                                  "\"\\u0000\"",
                                  "\"../../etc\"",
                                  "\"fluid.wall\"",
                                  "''' '''",
                                  "\"{}\"",
                                  "\"\\U0010FFFF\"",
                                  ""};

/// One line, key or value of a case in another place, or an odd one in its stead.
void mutate_words(std::string& text, Random& random)
{
  auto lines = lines_of(text);
  if (lines.empty()) return;
  const auto at = random.below(lines.size()), other = random.below(lines.size());
  auto& line = lines[at];
  const auto equals = line.find(" = "), others = lines[other].find(" = ");
  switch (random.below(9)) {
  case 0: lines.insert(lines.begin() + static_cast<std::ptrdiff_t>(other), std::string(line)); break;
  case 1: lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(at)); break;
  case 2: std::swap(line, lines[other]); break;
  case 3: // the value of another key
    if (equals == std::string::npos || others == std::string::npos) return;
    line = line.substr(0, equals) + lines[other].substr(others);
    break;
  case 4: // the key of another value
    if (equals == std::string::npos || others == std::string::npos) return;
    line = lines[other].substr(0, others) + line.substr(equals);
    break;
  case 5: // far deeper than any list or table of a case
    if (equals == std::string::npos || random.below(8) != 0) return;
    line = line.substr(0, equals + 3) + repeated(random.below(2) == 0 ? "[" : "{a=", random.below(1200));
    break;
  case 6: { // a key of many parts
    if (random.below(8) != 0) return;
    const auto key = repeated("a.", random.below(2) == 0 ? random.below(40) : random.below(40'000)) + "a";
    line = random.below(2) == 0 ? "[" + key + "]" : key + " = 1";
    break;
  }
  default:
    if (equals == std::string::npos) return;
    line = line.substr(0, equals + 3) + random.one_of(odd_values);
  }
  text.clear();
  for (const auto& each : lines) (text += each) += '\n';
}

/// @returns is it a case? Whether it is one or not, what is said about it is complete.
bool is_case(const std::string& text)
{
  const auto result = read_case_text(text, "damaged.toml", {});
  if (!result.diagnostics.empty()) {
    for (const auto& diagnostic : result.diagnostics) {
      CHECK_MESSAGE(diagnostic.place.starts_with("damaged.toml"), diagnostic.place);
      CHECK_MESSAGE(diagnostic.message.size() > 10, diagnostic.message);
    }
    return false;
  }
  CHECK(result.value.dt > 0.0);
  CHECK(result.value.start_time < result.value.end_time);
  CHECK(!result.value.scheme.empty());
  const auto again = read_case_text(result.value.text, "again.toml", {});
  for (const auto& diagnostic : again.diagnostics) CHECK_MESSAGE(false, diagnostic.place, ": ", diagnostic.message);
  CHECK(again.value.text == result.value.text);
  return true;
}

void damage_cases(std::uint64_t count)
{
  setenv("MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR, 1);
  const auto samples = sample_cases();
  REQUIRE(samples.size() > 100);

  std::uint64_t n_refused = 0, n_accepted = 0;
  for_each_mutation(count, [&](Random& random) {
    auto text = random.one_of(samples);
    if (random.below(4) == 0) mutate(text, 0, text.size(), random); // mostly no TOML any more
    else
      for (auto n = 1 + random.below(1 + random.below(8)); n > 0; --n) mutate_words(text, random);
    INFO("text:\n", text.substr(0, 4000));
    (is_case(text) ? n_accepted : n_refused) += 1;
  });
  CHECK(n_refused > count / 100);
  CHECK(n_accepted > count / 100); // far from all of them end at their first line
}

} // namespace

// What the damage below has found: the TOML library ran out of stack.
TEST_CASE("a key of a hundred thousand parts is a mistake with a place, wherever it stands")
{
  const auto deep = repeated("a.", 100'000) + "a", quoted = repeated("\"b.'\" . ", 100'000) + "'c'";
  for (const auto& key : {deep, quoted})
    for (const auto& text : {"\n  " + key + " = 1\n", "\n [" + key + "]\n", "\n [[" + key, "\nx={" + key + "=1}"}) {
      const auto result = read_case_text(text, "deep.toml", {});
      REQUIRE(result.diagnostics.size() == 1);
      CHECK(result.diagnostics[0].place.starts_with("deep.toml:2:"));
      CHECK(result.diagnostics[0].message == "a key of more than 8 parts; expected a table's name and a key's");
    }
  CHECK(!config::parse_key(deep));
  CHECK(config::parse_value("{" + deep + "=1}", {}).text() != nullptr); // no value: a text
}

// Found likewise: a driver took the first of no pairs.
TEST_CASE("a scheme that couples a pair is a mistake in a case that has none")
{
  setenv("MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR, 1);
  const auto result = read_case_text("[run]\nname = \"a\"\nend_time = 1\ndt = 0.1\n"
                                     "[fluid]\nmodule = \"trivial_fluid\"\nnodes = 20\n"
                                     "[driver]\nscheme = \"odd_wiring\"\nmistake = \"unfed\"\n",
                                     "alone.toml", {});
  REQUIRE(result.diagnostics.size() == 1);
  CHECK(result.diagnostics[0].place == "alone.toml:9:10");
  const auto& message = result.diagnostics[0].message;
  CHECK_MESSAGE(message.find("add [coupling] with interfaces = ") != std::string::npos, message);
}

TEST_CASE("texts and numbers with many dots are no keys of many parts")
{
  const auto is_read = [](const std::string& text) { return config::parse_toml(text).index() == 0; };
  CHECK(is_read("a = \"" + repeated("a.", 100) + "\"\n"));
  CHECK(is_read("a = '" + repeated("a.", 100) + "'\n"));
  CHECK(is_read("a = [" + repeated("0.5, ", 100) + "]\n"));
  CHECK(is_read("# " + repeated(".", 100) + repeated(" 1.5", 100) + "\na.b.c.d = 1\n"));
}

TEST_CASE("a damaged case file is a list of mistakes with places, or a case that reads back") { damage_cases(300); }

TEST_SUITE("full")
{
  TEST_CASE("40,000 damaged case files are lists of mistakes with places, or cases that read back")
  {
    damage_cases(40'000);
  }
}
