// read_case() on cases that are right; what it says about wrong ones is in tests/cli/broken_cases.
#include <mullion/app/case_file.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

using namespace mullion;

namespace {

/// A case file that is removed again; the test plug-ins are on the path.
class TemporaryCase {
public:
  explicit TemporaryCase(const std::string& text)
      : path_(std::filesystem::temp_directory_path() / ("mullion_case_" + std::to_string(getpid()) + ".toml"))
  {
    std::ofstream(path_) << text;
    setenv("MULLION_PLUGIN_PATH", MULLION_TEST_PLUGIN_DIR, 1);
  }
  ~TemporaryCase() { std::filesystem::remove(path_); }
  TemporaryCase(const TemporaryCase&) = delete;
  TemporaryCase& operator=(const TemporaryCase&) = delete;

  [[nodiscard]] Case read(const CaseOptions& options = {}) const
  {
    const auto result = read_case(path_.string(), options);
    for (const auto& diagnostic : result.diagnostics) FAIL(diagnostic.place << ": " << diagnostic.message);
    return result.value;
  }

private:
  std::filesystem::path path_;
};

const std::string tables = R"(
[structure]
module = "trivial_structure"
process = true

[fluid]
module = "many_parameters_fluid"
density = 1
courant = 0.1

[coupling]
interfaces = [["fluid.wall", "structure.wet"]]
reference_pressure = 101325

[driver]
scheme = "exchange"

[[expect]]
quantity = "fluid.energy"
amplitude = 0.3
source = "by hand"
)";
const std::string run = "[run]\nname = \"case\"\nend_time = 0.3\ndt = 0.1\n";

const ParameterValue& parameter_of(const ModuleCase& module, const std::string& name)
{
  for (const auto& parameter : module.parameters)
    if (parameter.name == name) return parameter;
  throw std::out_of_range(name);
}
double real(const ParameterValue& parameter) { return std::get<double>(parameter.value); }

} // namespace

TEST_CASE("a case is flattened: modules by kind, parameters in the order of their declaration")
{
  const auto value = TemporaryCase(run + tables).read();

  REQUIRE(value.modules.size() == 2);
  const auto& [fluid, structure] = std::pair(value.modules[0], value.modules[1]);
  CHECK(fluid.instance == "fluid");
  CHECK(fluid.kind == "fluid");
  CHECK(fluid.plugin == "many_parameters_fluid");
  CHECK(fluid.path == MULLION_TEST_PLUGIN_DIR "/many_parameters_fluid.so");
  CHECK(!fluid.is_process);
  CHECK(structure.instance == "structure");
  CHECK(structure.is_process);
  CHECK(fluid.parameters[0].name == "density");
  CHECK(value.interfaces.at(0).fluid == "fluid.wall");
  CHECK(value.interfaces.at(0).structure == "structure.wet");
  CHECK(value.scheme == "exchange");
  REQUIRE(value.connections.size() == 2);
  CHECK(value.connections[0].receiver == "fluid.wall.velocity");
  CHECK(value.connections[0].source == "structure.wet.velocity");
}

TEST_CASE("what a case leaves out has its default and says so")
{
  const auto value = TemporaryCase(run + tables).read();

  CHECK(value.start_time == 0.0);
  CHECK(value.on_failure == "stop");
  CHECK(value.call_deadline == 300.0);
  CHECK(value.start_deadline == 600.0);
  CHECK(value.output_every == 0);
  CHECK(value.has_history);
  const auto& cells = parameter_of(value.modules[0], "cells");
  CHECK(std::get<std::int64_t>(cells.value) == 100);
  CHECK(!cells.is_given);
  CHECK(parameter_of(value.modules[0], "courant").is_given);
}

TEST_CASE("an integer is taken where a real number is wanted")
{
  const auto value = TemporaryCase(run + tables).read();

  CHECK(real(parameter_of(value.modules[0], "density")) == 1.0);
}

TEST_CASE("the reference pressure of [coupling] goes to every module that declares one")
{
  const auto value = TemporaryCase(run + tables).read();

  CHECK(value.reference_pressure == 101325.0);
  CHECK(real(parameter_of(value.modules[0], "reference_pressure")) == 101325.0);
  CHECK(parameter_of(value.modules[0], "reference_pressure").is_given);
}

TEST_CASE("--inline and --processes overrule every process key, also in the case as it is run")
{
  const TemporaryCase file(run + tables);

  const auto all_inline = file.read({{}, true, false});
  const auto all_processes = file.read({{}, false, true});

  for (const auto& module : all_inline.modules) CHECK(!module.is_process);
  for (const auto& module : all_processes.modules) CHECK(module.is_process);
  for (const auto& module : TemporaryCase(all_inline.text).read().modules) CHECK(!module.is_process);
  for (const auto& module : TemporaryCase(all_processes.text).read().modules) CHECK(module.is_process);
}

TEST_CASE("the case as it is run reads back to the same case, bit for bit, overrides included")
{
  const CaseOptions options{{"run.dt=0.012345678901234567", "run.end_time=1e1", "fluid.offset=0.30000000000000004",
                             "fluid.label=a \"b\"", "output.every=7"},
                            false,
                            false};
  const auto first = TemporaryCase(run + tables).read(options);

  const auto second = TemporaryCase(first.text).read();

  CHECK(second.text == first.text);
  CHECK(std::bit_cast<std::uint64_t>(second.dt) == std::bit_cast<std::uint64_t>(0.012345678901234567));
  CHECK(second.end_time == 10.0);
  CHECK(second.output_every == 7);
  for (std::size_t m = 0; m < first.modules.size(); ++m) {
    REQUIRE(second.modules[m].parameters.size() == first.modules[m].parameters.size());
    for (std::size_t p = 0; p < first.modules[m].parameters.size(); ++p)
      CHECK(second.modules[m].parameters[p].value == first.modules[m].parameters[p].value);
  }
  REQUIRE(second.expectations.size() == 1);
  CHECK(second.expectations[0].amplitude == first.expectations[0].amplitude);
  CHECK(second.expectations[0].source == "by hand");
}

TEST_CASE("a case with Windows line ends and a byte order mark is read")
{
  std::string text = run + tables;
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.replace(at, 1, "\r\n");

  const auto value = TemporaryCase("\xef\xbb\xbf" + text).read();

  CHECK(value.name == "case");
}
