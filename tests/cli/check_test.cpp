// `mullion check` against cases that are wrong on purpose: the whole of standard error, word for word. Each file of
// broken_cases/ says at its top what is expected:
//
//   # arguments: --set fluid.nodes=0       more arguments, if any
//   # expect 12:3: message                 a diagnostic at line 12, column 3 of this file
//   # expect --set fluid.nodes=0: error: message     a diagnostic of another place: the whole line
//
// {plugins} and {install} stand for the plug-in folders of tests and build, {build} for the build id.
#include "support/run_process.hpp"

#include <mullion/coupling/build_id.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace mullion;
namespace fs = std::filesystem;

namespace {

const fs::path cases = fs::path(MULLION_SOURCE_DIR) / "tests/cli/broken_cases";

std::vector<fs::path> broken_cases()
{
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(cases))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::string with(std::string text, const std::string& name, const std::string& value)
{
  for (auto at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size()))
    text.replace(at, name.size(), value);
  return text;
}

struct Expected {
  std::vector<std::string> arguments;
  std::string err;
  int n_mistakes = 0;
};

Expected read_expected(const fs::path& file)
{
  const std::string name = file.filename().string();
  Expected expected;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line) && line.rfind("# ", 0) == 0;) {
    if (line.rfind("# arguments: ", 0) == 0) {
      std::istringstream words(line.substr(13));
      for (std::string word; words >> word;) expected.arguments.push_back(word);
      continue;
    }
    REQUIRE(line.rfind("# expect ", 0) == 0);
    ++expected.n_mistakes;
    std::string text = line.substr(9);
    if (std::isdigit(static_cast<unsigned char>(text[0])) != 0) {
      const auto place_end = text.find(": ");
      text = name + ":" + text.substr(0, place_end) + ": error" + text.substr(place_end);
    }
    text = with(text, "{plugins}", MULLION_TEST_PLUGIN_DIR);
    text = with(text, "{install}", fs::weakly_canonical(MULLION_BUILD_DIR "/lib/mullion/plugins").string());
    expected.err += with(text, "{build}", MULLION_BUILD_ID) + "\n";
  }
  expected.err += "mullion: error: " + name + " has " + std::to_string(expected.n_mistakes) + " mistake" +
                  (expected.n_mistakes == 1 ? "" : "s") + "\n";
  return expected;
}

test::ProcessResult check(const fs::path& file, const std::vector<std::string>& arguments)
{
  std::vector<std::string> command = {MULLION_BUILD_DIR "/bin/mullion", "check", file.filename().string()};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return test::run_process(command, {.environment = {{"MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR}},
                                     .folder = file.parent_path().string()});
}

} // namespace

TEST_CASE("every broken case is refused with all of its mistakes, each at its place")
{
  const auto files = broken_cases();
  REQUIRE(files.size() >= 108);

  for (const auto& file : files) {
    CAPTURE(file.filename().string());
    const auto expected = read_expected(file);

    const auto result = check(file, expected.arguments);

    CHECK(expected.n_mistakes > 0);
    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    CHECK(result.err == expected.err);
  }
}
