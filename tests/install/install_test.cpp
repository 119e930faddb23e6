// The outsider's view: Mullion is installed into a prefix, a module and a driver are built against it with
// find_package(mullion), and the installed program runs them. The module is examples/minimal_module as it is in the
// tree, the driver is the text of docs/how_to/add_driver.md.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

namespace fs = std::filesystem;

/// A program that must succeed.
ProcessResult succeed(const std::vector<std::string>& command,
                      const std::vector<std::pair<std::string, std::string>>& environment = {})
{
  auto result = run_process(command, {.environment = environment, .folder = "", .timeout = std::chrono::minutes(10)});
  REQUIRE_MESSAGE(result.exit_code == 0, command[0], " ", command[1], ": ", result.out, result.err);
  return result;
}

/// This build, installed into a temporary folder. Made once: it takes a second.
class Installation {
public:
  Installation() { succeed({"cmake", "--install", MULLION_BUILD_DIR, "--prefix", (folder_ / "prefix").string()}); }

  [[nodiscard]] std::string program() const { return (folder_ / "prefix/bin/mullion").string(); }
  [[nodiscard]] fs::path folder() const { return folder_.path(); }
  [[nodiscard]] bool owns(const std::string& path) const
  {
    return path.rfind((folder_ / "prefix").string() + "/", 0) == 0;
  }

  /// Configure and build a project against the installation. @return its build folder
  [[nodiscard]] fs::path build(const fs::path& source, const std::string& name) const
  {
    const auto build = folder_ / name;
    succeed({"cmake", "-S", source.string(), "-B", build.string(), "-G", "Ninja",
             "-DCMAKE_PREFIX_PATH=" + (folder_ / "prefix").string()});
    succeed({"cmake", "--build", build.string(), "-j", "1"});
    return build;
  }

  /// The installed `mullion`, which finds the plug-ins of its installation and those of the given folder.
  [[nodiscard]] ProcessResult mullion(const std::vector<std::string>& arguments, const fs::path& plugins) const
  {
    std::vector<std::string> command = {program()};
    command.insert(command.end(), arguments.begin(), arguments.end());
    return run_process(command, {.environment = {{"MULLION_PLUGIN_PATH", plugins.string()},
                                                 {"MULLION_RUNTIME_DIR", folder_.runtime().string()}},
                                 .folder = folder_.path().string(),
                                 .timeout = std::chrono::minutes(5)});
  }

private:
  RunFolder folder_;
};

const Installation& installation()
{
  static const Installation the_one;
  return the_one;
}

struct Series {
  std::vector<double> times, values;
};

/// A column of history.csv over its time.
Series read_history(const fs::path& file, const std::string& column)
{
  std::ifstream in(file);
  std::string line, cell;
  std::getline(in, line);
  std::istringstream head(line);
  std::ptrdiff_t wanted = -1;
  for (std::ptrdiff_t c = 0; std::getline(head, cell, ','); ++c)
    if (cell == column) wanted = c;
  REQUIRE_MESSAGE(wanted >= 0, "no column ", column);
  Series series;
  while (std::getline(in, line)) {
    std::istringstream row(line);
    for (std::ptrdiff_t c = 0; std::getline(row, cell, ','); ++c) {
      if (c == 1) series.times.push_back(std::stod(cell));
      if (c == wanted) series.values.push_back(std::stod(cell));
    }
  }
  return series;
}

/// From the first to the last upward crossing of the mean.
double frequency(const Series& s)
{
  const double mean = std::accumulate(s.values.begin(), s.values.end(), 0.0) / static_cast<double>(s.values.size());
  std::vector<double> crossings;
  for (std::size_t i = 1; i < s.values.size(); ++i) {
    const double before = s.values[i - 1] - mean, after = s.values[i] - mean;
    if (before < 0.0 && after >= 0.0)
      crossings.push_back(s.times[i] - (s.times[i] - s.times[i - 1]) * after / (after - before));
  }
  REQUIRE(crossings.size() >= 10);
  return static_cast<double>(crossings.size() - 1) / (crossings.back() - crossings.front());
}

/// The lowest root of k - M w^2 + z w cot(w L / c) = 0: a mass on a spring that closes a gas column, linear acoustics.
double exact_frequency()
{
  const double mass = 100.0, stiffness = 4.0e6, length = 1.0, c = std::sqrt(1.4 * 1.0e5 / 1.3), z = 1.3 * c;
  double low = 1e-3, high = std::numbers::pi * c / length * (1.0 - 1e-12); // the left-hand side falls in between
  for (int i = 0; i < 100; ++i) {
    const double w = 0.5 * (low + high);
    (stiffness - mass * w * w + z * w / std::tan(w * length / c) > 0.0 ? low : high) = w;
  }
  return low / (2.0 * std::numbers::pi);
}

/// The lines between "```cpp file=NAME" and "```".
std::string code_in(const std::string& document, const std::string& name)
{
  std::ifstream in(fs::path(MULLION_SOURCE_DIR) / document);
  std::string line, code;
  while (std::getline(in, line) && line != "```cpp file=" + name) {
  }
  while (std::getline(in, line) && line != "```") code += line + "\n";
  return code;
}

} // namespace

TEST_CASE("the installed program lists the installed plug-ins")
{
  const auto result = installation().mullion({"modules"}, "");

  CHECK(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(std::count(result.out.begin(), result.out.end(), '\n') >= 6);
}

TEST_CASE("the example module is built against the installation and swings with the exact frequency")
{
  const auto plugins = installation().build(fs::path(MULLION_SOURCE_DIR) / "examples/minimal_module", "spring_mass");
  const auto out = installation().folder() / "spring";

  const auto result = installation().mullion(
      {"run", MULLION_SOURCE_DIR "/examples/minimal_module/piston_on_spring.toml", "--out", out.string()}, plugins);

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  const auto u = read_history(out / "history.csv", "structure.wet.displacement");
  REQUIRE(std::all_of(u.values.begin(), u.values.end(), [](double v) { return std::isfinite(v); }));
  // Measured +3e-5: 20 cells, and a displacement of 5e-4 of the column's length in a gas that is not linear.
  CHECK(frequency(u) == doctest::Approx(exact_frequency()).epsilon(2e-4));
  const auto [low, high] = std::minmax_element(u.values.begin(), u.values.end());
  // Twice the static displacement 1000 Pa A / (k + gamma p0 A / L); 2 %: CSS lets it grow by 1 % in 20 swings.
  CHECK(*high - *low == doctest::Approx(2.0 * 1000.0 / (4.0e6 + 1.4e5)).epsilon(0.02));
}

TEST_CASE("the example module keeps no state outside its windows")
{
  const auto plugins = installation().build(fs::path(MULLION_SOURCE_DIR) / "examples/minimal_module", "spring_mass");
  for (const std::vector<std::string>& flags : {std::vector<std::string>{"--replay"}, {"--amnesia", "5"}}) {
    std::vector<std::string> command = {"run",   MULLION_SOURCE_DIR "/examples/minimal_module/piston_on_spring.toml",
                                        "--set", "run.end_time=0.002",
                                        "--out", (installation().folder() / "again").string()};
    command.insert(command.end(), flags.begin(), flags.end());

    const auto result = installation().mullion(command, plugins);

    CHECK_MESSAGE(result.exit_code == 0, flags[0], ": ", result.err);
  }
}

TEST_CASE("the driver of the how-to is built against the installation and runs, twice the same")
{
  const auto source = installation().folder() / "driver_source";
  const auto code = code_in("docs/how_to/add_driver.md", "smoothed_load_driver.cpp");
  REQUIRE(!code.empty());
  fs::create_directories(source);
  std::ofstream(source / "smoothed_load_driver.cpp") << code;
  std::ofstream(source / "CMakeLists.txt") << "cmake_minimum_required(VERSION 3.25)\n"
                                              "project(outside_driver LANGUAGES CXX)\n"
                                              "find_package(mullion 0.1 REQUIRED)\n"
                                              "mullion_add_driver(smoothed_load)\n";
  const auto plugins = installation().build(source, "driver");

  const auto result =
      installation().mullion({"run", MULLION_SOURCE_DIR "/configs/closed_piston.toml", "--inline", "--replay", "--set",
                              "driver.scheme=smoothed_load", "--set", "driver.smoothing=0.3", "--set",
                              "run.end_time=0.0005", "--out", (installation().folder() / "driven").string()},
                             plugins);

  CHECK_MESSAGE(result.exit_code == 0, result.err);
}
