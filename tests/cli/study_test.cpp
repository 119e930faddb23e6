// `mullion study` against study files that are wrong on purpose (broken_studies/, see support/broken_file.hpp), and its
// command line.
#include "support/broken_file.hpp"
#include "support/run_process.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <string>
#include <vector>

using namespace mullion;

namespace {

test::ProcessResult study_command(std::vector<std::string> arguments)
{
  arguments.insert(arguments.begin(), {MULLION_BUILD_DIR "/bin/mullion", "study"});
  return test::run_process(arguments, {.environment = {}, .folder = MULLION_SOURCE_DIR "/tests/cli"});
}

} // namespace

TEST_CASE("every broken study is refused with all of its mistakes, each at its place, and makes no folder")
{
  const std::filesystem::path folder = MULLION_SOURCE_DIR "/tests/cli/broken_studies";

  test::check_broken_files(folder, "study", 25);

  CHECK(!std::filesystem::exists(folder / "out"));
}

TEST_CASE("a study that is no file is one mistake")
{
  const auto missing = study_command({"no_such_study.toml"});

  CHECK(missing.exit_code == 2);
  CHECK(missing.out == "");
  CHECK(missing.err == "no_such_study.toml: error: cannot open no_such_study.toml: No such file or directory\n"
                       "mullion: error: no_such_study.toml has 1 mistake\n");
}

TEST_CASE("study has a help, and says what is wrong with its options")
{
  const auto help = study_command({"--help"});
  CHECK(help.exit_code == 0);
  CHECK(help.out.rfind("usage: mullion study STUDY [options]", 0) == 0);

  struct Wrong {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Wrong> wrongs = {
      {{}, "study: no study given; expected mullion study STUDY [options] (see mullion study --help)"},
      {{"a.toml", "-j", "0"}, "study: -j takes a whole number of runs, 1 or more (see mullion study --help)"},
      {{"a.toml", "--retyr"}, "study: unknown option '--retyr'; did you mean '--retry'? (see mullion study --help)"}};
  for (const auto& wrong : wrongs) {
    const auto result = study_command(wrong.arguments);

    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    CHECK(result.err == "mullion: error: " + wrong.message + "\n");
  }
}
