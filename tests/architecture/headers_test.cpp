// Every header compiles alone, with the flags with which the program itself is compiled.
#include "architecture/source_tree.hpp"
#include "support/run_process.hpp"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

/// Compiler, language, definitions and include folders of a source file of this build.
std::vector<std::string> compiler_and_flags(const std::string& source)
{
  std::ifstream in(MULLION_BUILD_DIR "/compile_commands.json");
  for (const auto& entry : nlohmann::json::parse(in)) {
    if (entry.at("file") != (source_root() / source).string()) continue;
    std::istringstream words(entry.at("command").get<std::string>());
    std::vector<std::string> command;
    for (std::string word; words >> word;) {
      const bool is_pair = word == "-isystem" || word == "-I";
      if (command.empty() || word.rfind("-I", 0) == 0 || word.rfind("-std=", 0) == 0 || is_pair)
        command.push_back(word);
      if (is_pair && words >> word) command.push_back(word);
    }
    return command;
  }
  return {};
}

/// What the compiler says of a header that stands alone; "" if it is content.
std::string complaint(std::vector<std::string> command, const std::string& header, const char* language)
{
  for (const std::string& word :
       {std::string("-fsyntax-only"), std::string("-Wall"), std::string("-Werror"), std::string("-include"),
        (source_root() / header).string(), std::string("-x"), std::string(language), std::string("/dev/null")})
    command.push_back(word);
  const auto result = run_process(command, {.environment = {}, .folder = "", .timeout = std::chrono::seconds(120)});
  return result.exit_code == 0 ? "" : result.err + " ";
}

void check_headers(const std::string& folder, const std::vector<std::string>& command)
{
  REQUIRE_MESSAGE(!command.empty(), "compile_commands.json has no such source file");
  for (const auto& header : files_under(folder, {".hpp", ".h"}))
    CHECK_MESSAGE(complaint(command, header, "c++") == "", header);
}

} // namespace

TEST_CASE("every public header compiles alone")
{
  const auto command = compiler_and_flags("framework/cli/main.cpp");

  for (const char* folder : {"framework/sdk", "framework/coupling", "framework/app"}) check_headers(folder, command);
}

TEST_CASE("the C boundary is C")
{
  auto command = compiler_and_flags("framework/cli/main.cpp");
  REQUIRE(!command.empty());
  std::erase_if(command, [](const auto& word) { return word.rfind("-std=", 0) == 0; });
  command.push_back("-std=c99");

  CHECK(complaint(command, "framework/sdk/include/mullion/sdk/abi.h", "c") == "");
}

TEST_SUITE("full")
{
  TEST_CASE("every header of the library and of the plug-ins compiles alone")
  {
    check_headers("framework/src", compiler_and_flags("framework/src/run/session.cpp"));
    auto command = compiler_and_flags("framework/cli/main.cpp");
    for (const auto& folders : {kernel_folders_of_tree(), shared_code_folders_of_tree()})
      for (const auto& folder : folders) // which others include as "folder/….hpp"
        command.push_back("-I" + (source_root() / folder).parent_path().string());
    check_headers("modules", command);
    check_headers("drivers", command);
    check_headers("examples", command);
  }
}
