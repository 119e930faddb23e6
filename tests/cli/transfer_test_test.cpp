// `mullion transfer-test` where the answer is known: two meshes of one line, 80 faces over 70. What it prints, how it
// refuses what cannot be, and what it leaves behind.
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

namespace fs = std::filesystem;

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// `mullion transfer-test` with these arguments.
ProcessResult transfer_test(const RunFolder& folder, std::vector<std::string> arguments)
{
  arguments.insert(arguments.begin(), "transfer-test");
  return folder.command(arguments);
}

/// The same between 80 and 70 equal faces of the line from (0, 0) to (1, 0), with a traction and a velocity.
ProcessResult on_lines(const RunFolder& folder, const std::string& traction, const std::string& velocity,
                       const std::vector<std::string>& more)
{
  std::vector<std::string> arguments = {"--source",   "line:80", "--target", "line:70",
                                        "--traction", traction,  "--motion", velocity};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return transfer_test(folder, arguments);
}

const std::string constant_traction = "100; 1e4", constant_velocity = "0.05; 0.1"; // Pa, m/s
const std::string wavy_traction = "0; 1e4*sin(3*x)", wavy_velocity = "0; cos(2*x)";

/// The numbers behind this label at the start of a line; none if there is no such line.
std::vector<double> numbers_behind(const std::string& label, const std::string& printed)
{
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    const auto first = line.find_first_not_of(' ');
    if (first == std::string::npos || line.compare(first, label.size(), label) != 0) continue;
    std::istringstream rest(line.substr(first + label.size()));
    std::vector<double> numbers;
    for (double number = 0.0; rest >> number;) numbers.push_back(number);
    return numbers;
  }
  return {};
}

/// The first of them; NaN, with which every comparison fails, if there is none.
double number_behind(const std::string& label, const std::string& printed)
{
  const auto numbers = numbers_behind(label, printed);
  return numbers.empty() ? std::nan("") : numbers.front();
}

double traction_error(const std::string& printed)
{
  return number_behind("traction on the structure, L2, relative", printed);
}

double largest_traction_error(const std::string& printed)
{
  return number_behind("traction on the structure, largest, relative", printed);
}

/// By how much the two sides of "force_y", "power", … differ, as printed.
double difference_of(const std::string& what, const std::string& printed)
{
  const auto numbers = numbers_behind(what, printed);
  return numbers.size() == 3 ? numbers[2] : std::nan("");
}

double relative_difference(double value, double reference) { return std::abs(value / reference - 1.0); }

const std::vector<std::string> loads_to_traction = {
    "--set", "fluid.on=load", "--set", "driver.fluid_exports=load", "--set", "driver.structure_receives=traction"};

} // namespace

TEST_CASE("a constant traction arrives exactly by common refinement, and keeps force, moment and power")
{
  for (const std::vector<std::string>& source : // values of nodes, and of faces
       {std::vector<std::string>{}, {"--set", "driver.fluid_exports=traction", "--set", "fluid.on=faces"}}) {
    const RunFolder folder;

    const auto result = on_lines(folder, constant_traction, constant_velocity, source);

    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    CHECK(result.err == "");                   // meshes that fit are not remarked upon
    CHECK(traction_error(result.out) < 1e-12); // round-off of a well conditioned solve
    CHECK(largest_traction_error(result.out) < 1e-12);
    CHECK(number_behind("motion on the fluid, L2, relative", result.out) < 1e-12);
    for (const char* what : {"force_x", "force_y", "moment_z", "power"}) CHECK(difference_of(what, result.out) < 1e-12);
    // Integrals of the given traction and velocity over the line, by hand. Nine digits are printed.
    CHECK(relative_difference(number_behind("force_y", result.out), 1e4) < 1e-8);
    CHECK(relative_difference(number_behind("moment_z", result.out), 5e3) < 1e-8);
    CHECK(relative_difference(number_behind("power", result.out), 100 * 0.05 + 1e4 * 0.1) < 1e-8);
    CHECK(number_behind("least coverage of a fluid face", result.out) == doctest::Approx(1.0).epsilon(1e-12));
    CHECK(number_behind("nodes without a counterpart", result.out) == 0.0);
    CHECK(number_behind("peak memory", result.out) > 0.0);
  }
}

TEST_CASE("a linear traction arrives exactly by common refinement and not by projection")
{
  const RunFolder folder;
  const std::string linear = "0; 1e4*(1 + 2*x)";

  const auto refined = on_lines(folder, linear, constant_velocity, {});
  const auto projected = on_lines(folder, linear, constant_velocity, {"--method", "node_projection"});

  REQUIRE_MESSAGE(refined.exit_code == 0, refined.err);
  REQUIRE_MESSAGE(projected.exit_code == 0, projected.err);
  CHECK(traction_error(refined.out) < 1e-12);  // round-off
  CHECK(traction_error(projected.out) > 0.01); // so the check above can fail
}

TEST_CASE("projections miss a constant traction by what they are known to miss it by")
{
  // Of a separate implementation of both formulas on these meshes, with another solver, in the norm that is printed:
  // squares weighted by each node's share of the line. The integral of the square of the linear error is smaller:
  // 0.0521087, 0.0176751, 0.0103548 and 3.67127e-4 (tests/verification/transfer2d_test.cpp).
  struct Known {
    std::string method;
    std::vector<std::string> options;
    double l2, largest;
  };
  const std::vector<Known> known = {{"node_projection", {}, 0.0752839, 0.173780},
                                    {"nearest_projection", {}, 0.0752839, 0.173780},
                                    {"quadrature_projection", {}, 0.0235187, 0.0356257}, // two points are the default
                                    {"quadrature_projection", {"--set", "transfer.points=4"}, 0.0166220, 0.0204838},
                                    {"quadrature_projection", {"--set", "transfer.points=16"}, 5.98939e-4, 7.11658e-4}};
  for (const auto& [method, options, l2, largest] : known) {
    const RunFolder folder;
    CAPTURE(method);
    auto more = options;
    more.insert(more.end(), {"--method", method});

    const auto result = on_lines(folder, constant_traction, constant_velocity, more);

    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    CHECK(relative_difference(traction_error(result.out), l2) < 1e-5); // six digits are printed
    CHECK(relative_difference(largest_traction_error(result.out), largest) < 1e-5);
    CHECK(difference_of("force_y", result.out) < 1e-12); // they keep the force all the same
    CHECK(difference_of("force_x", result.out) < 1e-12);
  }
}

TEST_CASE("adjoint motion keeps the power of common refinement, interpolation does not; of node projection both do")
{
  const RunFolder folder;
  const auto power_difference = [&](const std::string& method, const std::string& motion) {
    const auto result =
        on_lines(folder, wavy_traction, wavy_velocity, {"--method", method, "--set", "transfer.motion=" + motion});
    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    return difference_of("power", result.out);
  };

  CHECK(power_difference("common_refinement", "adjoint") < 1e-12); // round-off
  CHECK(power_difference("quadrature_projection", "adjoint") < 1e-12);
  CHECK(power_difference("node_projection", "adjoint") < 1e-12);
  CHECK(power_difference("node_projection", "interpolate") < 1e-12);
  // Off by O(h^2), not by round-off: h^2/12 |v''| / |v| = 4^2/12 / 80^2 = 5e-5 for this wave.
  CHECK(power_difference("common_refinement", "interpolate") > 1e-6);
  CHECK(power_difference("common_refinement", "interpolate") < 1e-3);
}

TEST_CASE("nodal forces become a traction only where that is allowed")
{
  const RunFolder folder;

  const auto refused = on_lines(folder, constant_traction, constant_velocity, loads_to_traction);
  auto with_recovery = loads_to_traction;
  with_recovery.insert(with_recovery.end(), {"--set", "driver.recover=true"});
  const auto allowed = on_lines(folder, constant_traction, constant_velocity, with_recovery);
  const auto to_loads = on_lines(
      folder, constant_traction, constant_velocity,
      {"--set", "fluid.on=load", "--set", "driver.fluid_exports=load", "--set", "driver.structure_receives=load"});

  CHECK(refused.exit_code == 2);
  CHECK(refused.out == "");
  CHECK_MESSAGE(has(refused.err, "driver transfer_probe: fluid_exports = \"load\" with structure_receives = "
                                 "\"traction\": nodal forces are no traction; let the structure receive the load, or "
                                 "allow a traction that is recovered from it: recover = true"),
                refused.err);
  REQUIRE_MESSAGE(allowed.exit_code == 0, allowed.err);
  CHECK(traction_error(allowed.out) < 1e-12); // round-off of two solves
  CHECK(difference_of("force_y", allowed.out) < 1e-12);
  REQUIRE_MESSAGE(to_loads.exit_code == 0, to_loads.err);
  CHECK(traction_error(to_loads.out) < 1e-12);
  CHECK(difference_of("force_y", to_loads.out) < 1e-12);
}

TEST_CASE("surfaces that are far apart are an error with the distance, or a warning with the places")
{
  const RunFolder folder;
  const std::vector<std::string> apart = {"--source",   "line:80,from=0:0.5,to=1:0.5",
                                          "--target",   "line:70",
                                          "--traction", constant_traction,
                                          "--motion",   constant_velocity};
  auto all_the_same = apart;
  all_the_same.insert(all_the_same.end(), {"--set", "transfer.on_misfit=warn"});

  const auto refused = transfer_test(folder, apart);
  const auto warned = transfer_test(folder, all_the_same);

  CHECK(refused.exit_code == 1);
  CHECK(refused.out == "");
  CHECK_MESSAGE(has(refused.err, "module 'transfer' (common_refinement, inline) failed in attach, before the first "
                                 "step: the two interfaces do not fit: the surfaces are up to 0.5 m apart, 35 faces; "
                                 "at most 2 faces are sensible"), // 0.5 m in faces of 1/70 m
                refused.err);
  CHECK(has(refused.err, "on_misfit = \"warn\""));
  REQUIRE_MESSAGE(warned.exit_code == 0, warned.err);
  CHECK_MESSAGE(has(warned.err, "the surfaces are up to 0.5 m apart"), warned.err);
  CHECK(has(warned.err, "node 0 at (0, 0.5) m; node 80 at (1, 0.5) m"));
  CHECK(has(warned.err, "node 0 at (0, 0) m; node 70 at (1, 0) m"));
  CHECK(number_behind("largest gap", warned.out) == doctest::Approx(0.5).epsilon(1e-12));
  CHECK(difference_of("force_y", warned.out) < 1e-12); // kept all the same
}

TEST_CASE("a source that reaches beyond the target is an error, or a warning if it is less than half a face")
{
  const RunFolder folder;
  const auto reaching = [&](const std::string& mesh) {
    return transfer_test(folder, {"--source", mesh, "--target", "line:70", "--traction", constant_traction, "--motion",
                                  constant_velocity});
  };

  const auto far = reaching("line:82,to=1.03:0"); // 2.1 faces of 1/70
  const auto little = reaching("line:83,to=1.005:0");

  CHECK(far.exit_code == 1);
  CHECK_MESSAGE(has(far.err, "the source reaches 0.03 m beyond the target's end, 2.1 faces"), far.err);
  REQUIRE_MESSAGE(little.exit_code == 0, little.err);
  CHECK_MESSAGE(has(little.err, "the source reaches 0.005 m beyond the target's end"), little.err);
  CHECK(has(little.err, "node 83 at (1.005, 0) m"));
  CHECK(difference_of("force_y", little.out) < 1e-12);
  // 1/1.005; six digits are printed
  CHECK(number_behind("covered fraction of the fluid's surface", little.out) ==
        doctest::Approx(0.995025).epsilon(1e-5));
}

TEST_CASE("a transfer that loses force is told once in a run, with both numbers and the place")
{
  const RunFolder folder;
  const auto run = [&](const std::string& transfer) {
    return folder.run(
        {.file = MULLION_SOURCE_DIR "/configs/transfer_test.toml",
         .sets = {"run.end_time=5", "fluid.mesh=line:80", "structure.mesh=line:70", "fluid.function=100; 1e4",
                  "fluid.expected_motion=0.05; 0.1", "structure.function=0.05; 0.1",
                  "structure.expected_traction=100; 1e4", "transfer.module=" + transfer}});
  };
  const auto complaint = [](const std::string& text) { return text.find("the target receives the force ("); };

  const auto leaky = run("leaky_transfer"), sound = run("node_projection");

  REQUIRE_MESSAGE(leaky.exit_code == 0, leaky.err);
  const auto first = complaint(leaky.err);
  REQUIRE_MESSAGE(first != std::string::npos, leaky.err);
  CHECK(complaint(leaky.err.substr(first + 1)) == std::string::npos); // in none of the other steps
  const auto line = leaky.err.substr(first, leaky.err.find('\n', first) - first);
  // A tenth of node 3's share, which is 1/80 of the line's: 100 Pa m and 1e4 Pa m less 1/800 of them.
  CHECK_MESSAGE(has(line, "(99.875, 9987.5, 0) N, the source gives (100, 10000, 0) N: relative defect 0.00125"), line);
  // The tractions of its neighbours make a part of its load.
  CHECK_MESSAGE(has(line, "the loads of 3 source nodes (node 2 at (0.025, 0) m; node 3 at (0.0375, 0) m; node 4 at "
                          "(0.05, 0) m) do not arrive whole (said once; history.csv has every step)"),
                line);
  REQUIRE_MESSAGE(sound.exit_code == 0, sound.err);
  CHECK(complaint(sound.err) == std::string::npos);
}

TEST_CASE("the results of a transfer test are those of a run: fields for ParaView, a history, a record")
{
  const RunFolder folder;

  const auto result = on_lines(folder, constant_traction, constant_velocity, {});
  const auto elsewhere = on_lines(folder, constant_traction, constant_velocity, {"--out", "elsewhere"});

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  CHECK(has(result.out, "both fields for ParaView: out/transfer-test/results.xdmf\n"));
  for (const char* file : {"results.xdmf", "results.h5", "history.csv", "run.json", "case.toml"})
    CHECK_MESSAGE(fs::exists(folder / "out/transfer-test" / file), file);
  CHECK(last_step(folder / "out/transfer-test") == 1);
  REQUIRE_MESSAGE(elsewhere.exit_code == 0, elsewhere.err);
  CHECK(has(elsewhere.out, "both fields for ParaView: elsewhere/results.xdmf\n"));
  CHECK(fs::exists(folder / "elsewhere/results.xdmf"));
}

TEST_CASE("a case of one's own is run in place of the one that is shipped")
{
  const RunFolder folder;

  const auto shipped = transfer_test(folder, {});
  const auto own = transfer_test(folder, {MULLION_SOURCE_DIR "/configs/transfer_test.toml"});
  const auto missing = transfer_test(folder, {"no_such_case.toml"});

  REQUIRE_MESSAGE(shipped.exit_code == 0, shipped.err);
  REQUIRE_MESSAGE(own.exit_code == 0, own.err);
  const auto without_times = [](const std::string& text) { return text.substr(0, text.find("\ntime\n")); };
  CHECK(without_times(own.out) == without_times(shipped.out)); // the same file, the same digits
  CHECK(has(own.out, "\ntime\n"));
  CHECK(missing.exit_code == 2);
  CHECK(missing.err == "no_such_case.toml: error: cannot be read: No such file or directory\n"
                       "mullion: error: no_such_case.toml has 1 mistake\n");
}

TEST_CASE("transfer-test has a help")
{
  const RunFolder folder;

  const auto result = transfer_test(folder, {"--help"});

  CHECK(result.exit_code == 0);
  CHECK(result.err == "");
  CHECK(result.out.rfind("usage: mullion transfer-test [CASE] [options]", 0) == 0);
  for (const char* option : {"--source MESH", "--target MESH", "--method NAME", "--traction EXPR", "--motion EXPR",
                             "--set KEY=VALUE", "--out DIR"})
    CHECK_MESSAGE(has(result.out, option), option);
}

TEST_CASE("what transfer-test cannot use is refused with what is wrong and the exit code 2")
{
  struct Wrong {
    std::vector<std::string> arguments;
    std::string message;
  };
  const std::vector<Wrong> wrongs = {
      {{"--method", "comon_refinement"}, "there is no plug-in 'comon_refinement'; did you mean 'common_refinement'?"},
      {{"--source", "nowhere.msh"},
       "module 'fluid' (probe_fluid, inline) failed in define, before the first step: nowhere.msh: cannot be read (No "
       "such file or directory); a path is taken from the folder in which the run was "
       "started"},
      {{"--target", "circle:80"}, "circle:80: of unknown format; mesh files end in .msh, .vtk or .vtu"},
      {{"--source", "line:80", "--target", "line:70", "--traction", "0; 0; 1e4", "--motion", "0; 1"},
       "function: expression \"0; 0; 1e4\": 3 parts; 2, one for each dimension"},
      {{"--set", "transfer.pionts=3"}, "[transfer] knows no key 'pionts' (plug-in common_refinement)"},
      {{"--sorce", "line:80"}, "transfer-test: unknown option '--sorce'; did you mean '--source'?"}};
  for (const auto& wrong : wrongs) {
    const RunFolder folder;
    CAPTURE(wrong.arguments.front());

    const auto result = transfer_test(folder, wrong.arguments);

    CHECK(result.exit_code == 2);
    CHECK(result.out == "");
    CHECK_MESSAGE(has(result.err, wrong.message), result.err);
  }
}
