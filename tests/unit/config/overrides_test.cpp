#include "config/overrides.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"

#include <doctest/doctest.h>

using namespace mullion::config;

namespace {

Node document(const std::string& text) { return std::get<Node>(parse_toml(text)); }

/// The document after the overrides, as TOML; the overrides are right.
std::string overridden(const std::string& text, const std::vector<std::string>& overrides)
{
  Node root = document(text);
  Diagnostics diagnostics;
  apply_overrides(root, overrides, diagnostics);
  REQUIRE(diagnostics.empty());
  return write_toml(root);
}

} // namespace

TEST_CASE("--set replaces a value, whatever its type was")
{
  CHECK(overridden("[run]\ndt = 0.1\n", {"run.dt=2"}) == "[run]\ndt = 2\n");
  CHECK(overridden("[run]\ndt = 0.1\n", {"run.dt=1e-5"}) == "[run]\ndt = 1e-05\n");
  CHECK(overridden("[run]\nname = \"a\"\n", {"run.name=\"b c\""}) == "[run]\nname = \"b c\"\n");
}

TEST_CASE("--set takes what is no TOML value as a text")
{
  CHECK(parse_value("css", {}).text() != nullptr);
  CHECK(*parse_value("css", {}).text() == "css");
  CHECK(*parse_value("", {}).text() == "");
  CHECK(*parse_value("1 # not a comment", {}).text() == "1 # not a comment");
  CHECK(*parse_value("1, 2", {}).text() == "1, 2");
  CHECK(*parse_value("1,", {}).text() == "1,");
  CHECK(*parse_value("1]\nother = [2", {}).text() == "1]\nother = [2");
}

TEST_CASE("--set knows every type of TOML")
{
  CHECK(std::get<std::int64_t>(parse_value("10", {}).value) == 10);
  CHECK(std::get<double>(parse_value("1e-5", {}).value) == 1e-5);
  CHECK(std::get<bool>(parse_value("true", {}).value));
  CHECK(*parse_value("'a.b=c'", {}).text() == "a.b=c");
  CHECK(std::get<List>(parse_value("[[1, 2], [3]]", {}).value).size() == 2);
  CHECK(parse_value("{a = 1}", {}).table()->find("a") != nullptr);
}

TEST_CASE("--set makes keys and tables that are missing")
{
  CHECK(overridden("[run]\ndt = 0.1\n", {"run.name=a", "driver.scheme=css"}) ==
        "[run]\ndt = 0.1\nname = \"a\"\n\n[driver]\nscheme = \"css\"\n");
}

TEST_CASE("a later --set wins") { CHECK(overridden("", {"run.dt=1.0", "run.dt=2.0"}) == "[run]\ndt = 2.0\n"); }

TEST_CASE("a value may contain an equals sign, and a key quotes")
{
  CHECK(overridden("", {"run.name=a=b"}) == "[run]\nname = \"a=b\"\n");
  CHECK(overridden("", {"run.\"two words\"=1"}) == "[run]\n\"two words\" = 1\n");
}

TEST_CASE("the place of an overridden value is the flag")
{
  Node root = document("[run]\ndt = 0.1\n");
  Diagnostics diagnostics;

  apply_overrides(root, {"run.dt=2"}, diagnostics);

  const auto* dt = root.table()->find("run")->value.table()->find("dt");
  CHECK(dt->place.flag == "--set run.dt=2");
  CHECK(dt->value.place.flag == "--set run.dt=2");
}

TEST_CASE("a --set that cannot be done is a diagnostic at the flag and changes nothing")
{
  for (const char* wrong : {"run.dt", "=3", "run.=3", "run.dt.x=3", "run.name=\xff"}) {
    Node root = document("[run]\ndt = 0.1\n");
    Diagnostics diagnostics;

    apply_overrides(root, {wrong}, diagnostics);

    REQUIRE(diagnostics.size() == 1);
    CHECK(diagnostics.sorted("case.toml")[0].place == std::string("--set ") + wrong);
    CHECK(write_toml(root) == "[run]\ndt = 0.1\n");
  }
}
