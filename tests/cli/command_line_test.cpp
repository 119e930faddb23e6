// The outside of the program: help, versions, wrong commands, the list of plug-ins, and a case that is right.
#include "support/run_process.hpp"

#include <doctest/doctest.h>

#include <regex>
#include <string>
#include <vector>

#include <unistd.h>

using namespace mullion;

namespace {

test::ProcessResult mullion_command(const std::vector<std::string>& arguments)
{
  std::vector<std::string> command = {MULLION_BUILD_DIR "/bin/mullion"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return test::run_process(command, {.environment = {{"MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR}},
                                     .folder = MULLION_SOURCE_DIR "/tests/cli"});
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

} // namespace

TEST_CASE("mullion alone and --help show the commands")
{
  for (const auto& arguments : std::vector<std::vector<std::string>>{{}, {"--help"}, {"-h"}}) {
    const auto result = mullion_command(arguments);

    CHECK(result.exit_code == 0);
    CHECK(result.err == "");
    for (const char* command :
         {"run CASE", "check CASE", "study STUDY", "modules [NAME]", "report DIR", "ps", "stop RUN",
          "inspect RUN [WINDOW[.FIELD]]", "set RUN KEY=VALUE", "swap RUN KIND=MODULE", "checkpoint RUN"})
      CHECK(has(result.out, command));
  }
}

TEST_CASE("--version names the version, the plug-in ABI and the build")
{
  const auto result = mullion_command({"--version"});

  CHECK(result.exit_code == 0);
  CHECK(result.out.rfind("mullion ", 0) == 0);
  CHECK(has(result.out, "plug-in ABI 2"));
}

TEST_CASE("each command has a help")
{
  for (const char* command : {"check", "modules", "report", "inspect", "set", "swap", "checkpoint"}) {
    const auto result = mullion_command({command, "--help"});

    CHECK(result.exit_code == 0);
    CHECK(result.out.rfind(std::string("usage: mullion ") + command, 0) == 0);
  }
}

TEST_CASE("a wrong command line says what is meant and exits with 2")
{
  struct Wrong {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Wrong> wrongs = {
      {{"chek"}, "unknown command 'chek'; did you mean 'check'? (see mullion --help)"},
      {{"--verbose"}, "unknown option '--verbose'; options stand behind the command (see mullion --help)"},
      {{"check"}, "check: no case given; expected mullion check CASE [options] (see mullion check --help)"},
      {{"check", "a.toml", "b.toml"},
       "check: too many arguments; expected mullion check CASE [options] (see mullion check --help)"},
      {{"check", "a.toml", "--inlin"},
       "check: unknown option '--inlin'; did you mean '--inline'? (see mullion check --help)"}};
  for (const auto& wrong : wrongs) {
    const auto result = mullion_command(wrong.arguments);

    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    CHECK(result.err == "mullion: error: " + wrong.message + "\n");
  }
}

TEST_CASE("a case that is no file is one mistake")
{
  const auto missing = mullion_command({"check", "no_such_case.toml"});
  const auto folder = mullion_command({"check", "broken_cases"});

  CHECK(missing.exit_code == 2);
  CHECK(missing.err == "no_such_case.toml: error: cannot be read: No such file or directory\n"
                       "mullion: error: no_such_case.toml has 1 mistake\n");
  CHECK(folder.exit_code == 2);
  CHECK(folder.err == "broken_cases: error: is a folder; expected a case file in TOML\n"
                      "mullion: error: broken_cases has 1 mistake\n");
}

TEST_CASE("a case that is right shows who feeds whom")
{
  const auto result = mullion_command({"check", "good_case.toml", "--set", "fluid.process=true"});

  CHECK(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(result.out == "good_case.toml: ok\n"
                      "\n"
                      "run          good-case: 0 s to 0.5 s in 50 steps of 0.01 s; on failure: stop\n"
                      "modules      fluid      fluid        trivial_fluid      process\n"
                      "             structure  structure    trivial_structure  inline\n"
                      "driver       exchange\n"
                      "interface    fluid.wall | structure.wet, reference pressure 0 Pa\n"
                      "connections  structure.wet.velocity -> fluid.wall.velocity  (bound, constant)\n"
                      "             fluid.wall.traction    -> structure.wet.traction  (bound, constant)\n"
                      "output       a result file every 10 steps, history.csv\n");
}

TEST_CASE("modules lists what can be used and says why a library was refused")
{
  const auto result = mullion_command({"modules"});

  CHECK(result.exit_code == 0);
  const auto table = std::regex_replace(result.out, std::regex(" +"), " "); // columns are as wide as they need be
  CHECK(has(table, "\nfluid trivial_fluid 0.1.0"));
  CHECK(has(table, "\ndriver exchange 0.1.0"));
  CHECK(!has(result.out, "wrong_abi"));
  for (const char* refused :
       {"wrong_abi.so: built for plug-in ABI 999", "not_a_plugin.so: not a Mullion plug-in",
        "wrong_build.so: compiled against another build", "wrong_name.so: the library calls itself"})
    CHECK(has(result.err, refused));
}

TEST_CASE("modules NAME prints every parameter with type, unit, default and range")
{
  const auto result = mullion_command({"modules", "many_parameters_fluid"});

  CHECK(result.exit_code == 0);
  for (const char* line : {"density             real     kg/m^3  required  > 0                 mass per volume",
                           "courant             real     1       0.5       in (0, 1]           Courant number",
                           "limited             boolean          true                          limit the slopes",
                           "flux                text             \"hllc\"    hllc | roe | exact  Riemann solver",
                           "wall.traction  Pa    node  vector      output  intensive"})
    CHECK_MESSAGE(has(result.out, line), line);
}

TEST_CASE("modules of an unknown name suggests the nearest")
{
  const auto result = mullion_command({"modules", "trivial_fluidd"});

  CHECK(result.exit_code == 2);
  CHECK(has(result.err, "there is no plug-in 'trivial_fluidd'; did you mean 'trivial_fluid'?"));
}
