// Strong coupling where nothing else works: the added-mass problem of Causin, Gerbeau, Nobile 2005, at four densities
// of the wall. How many iterations each acceleration needs, that all of them find the solution of the coupled system
// (support/added_mass.hpp), and that what does not converge is never taken for a result.
#include "support/added_mass.hpp"
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <fmt/format.h>

#include <array>
#include <string>
#include <vector>

using namespace mullion::test;
using mullion::testing::added_mass_cases;

namespace {

using Sets = std::vector<std::string>;

/// 50 steps; the tolerances 1e-6 are relative alone, as those of the reference numbers.
CaseRun wall_run(double density, const Sets& sets)
{
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/verification/added_mass.toml";
  run.flags = {"--inline"};
  run.sets = {fmt::format("structure.density={}", density), "driver.motion_floor=0", "driver.traction_floor=0"};
  run.sets.insert(run.sets.end(), sets.begin(), sets.end());
  return run;
}

struct Effort {
  double iterations; ///< mean over the steps
  double norm;       ///< of the displacement after the last step [m]
};

Effort effort(double density, const Sets& sets)
{
  const RunFolder folder;
  const auto result = folder.run(wall_run(density, sets));
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  const auto history = read_history(folder / "out/history.csv");
  const auto& iterations = history.at("driver.iterations");
  REQUIRE(iterations.size() == 51);
  double sum = 0.0;
  for (std::size_t i = 1; i < iterations.size(); ++i) sum += iterations[i];
  return {sum / 50.0, history.at("structure.wet.displacement_norm").back()};
}

/// A run that must end otherwise: exit code, and what the user reads.
ProcessResult refused(double density, const Sets& sets)
{
  const RunFolder folder;
  return folder.run(wall_run(density, sets));
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// css knows no tolerances.
CaseRun css_run(double density)
{
  auto run = wall_run(density, {});
  run.sets = {run.sets[0], "driver.scheme=css", "coupling.displacement_limit=1", "run.end_time=0.04"};
  return run;
}

// 3e-6: what the iteration's tolerance of 1e-6 in each step leaves after 50.
constexpr double norm_tolerance = 3e-6;

} // namespace

TEST_CASE("quasi-Newton iterations need as few evaluations as they should, and find the coupled solution")
{
  // Bounds: mean iterations of a separate tool (3.06, 3.20, 3.58, 4.60; parallel 2.96, 3.50, 4.82, 7.30) and of preCICE
  // (3.34, 3.70, 4.18, 5.48; parallel 3.20, 5.16, 6.98, 8.46), rounded up.
  constexpr std::array serial = {3.3, 3.7, 4.2, 5.2}, parallel = {3.2, 5.2, 7.0, 8.5};
  for (std::size_t i = 0; i < added_mass_cases.size(); ++i) {
    const auto& wall = added_mass_cases[i];
    CAPTURE(wall.solid_density);

    const auto one_after_the_other = effort(wall.solid_density, {});
    const auto at_the_same_time = effort(wall.solid_density, {"driver.iteration=parallel"});

    CHECK(one_after_the_other.iterations <= serial[i]);
    CHECK(at_the_same_time.iterations <= parallel[i]);
    CHECK(one_after_the_other.norm == doctest::Approx(wall.norm).epsilon(norm_tolerance));
    CHECK(at_the_same_time.norm == doctest::Approx(wall.norm).epsilon(norm_tolerance));
  }
}

TEST_CASE("from the last step's motion the iterations are those of a separate implementation")
{
  // 5 % for IQN-ILS, where the filter of columns decides on a few; 2 % for Aitken, which has no such choice.
  constexpr std::array iqn_ils = {3.40, 3.70, 4.10, 5.16};
  for (std::size_t i = 0; i < added_mass_cases.size(); ++i) {
    const auto& wall = added_mass_cases[i];
    CAPTURE(wall.solid_density);

    CHECK(effort(wall.solid_density, {"driver.predictor=constant"}).iterations ==
          doctest::Approx(iqn_ils[i]).epsilon(0.05));
    CHECK(effort(wall.solid_density, {"driver.predictor=constant", "driver.acceleration=aitken"}).iterations ==
          doctest::Approx(wall.iterations).epsilon(0.02));
  }
}

TEST_CASE("every acceleration finds the same solution")
{
  // Constant relaxation converges for theta < 2 / (1 + mass ratio).
  constexpr std::array theta = {0.9, 0.5, 0.2, 0.02};
  for (std::size_t i = 0; i < added_mass_cases.size(); ++i) {
    const auto& wall = added_mass_cases[i];
    CAPTURE(wall.solid_density);
    for (const Sets& sets : {Sets{"driver.acceleration=constant", fmt::format("driver.relaxation={}", theta[i]),
                                  "driver.max_iterations=1000"},
                             Sets{"driver.acceleration=aitken"}, Sets{"driver.acceleration=iqn_mvj"},
                             Sets{"driver.acceleration=iqn_mvj", "driver.iteration=parallel"}, Sets{"driver.reuse=0"},
                             Sets{"driver.predictor=quadratic"}}) { // which hits the first traction to round-off
      CAPTURE(fmt::format("{}", fmt::join(sets, " ")));
      CHECK(effort(wall.solid_density, sets).norm == doctest::Approx(wall.norm).epsilon(norm_tolerance));
    }
  }
}

TEST_CASE("css runs on a wall heavier than the added mass, and is ended with the reason on a lighter one")
{
  // Unstable if and only if the added mass outweighs the wall, at any step: ratios 0.0995, 0.995, 7.46, 67.8.
  for (const auto& wall : added_mass_cases) {
    CAPTURE(wall.solid_density);
    const RunFolder folder;
    const auto result = folder.run(css_run(wall.solid_density));
    CAPTURE(result.err);

    if (wall.mass_ratio < 1.0) {
      CHECK(result.exit_code == 0);
      CHECK(last_step(folder / "out") == 400);
    } else {
      CHECK(result.exit_code == 1);
      CHECK(has(result.err, "added mass"));
      CHECK(has(result.err, "displacement_limit"));
      CHECK(last_step(folder / "out") < 20);
    }
  }
}

TEST_CASE("schemes that would predict the wall's motion or need its rates are not offered for displacements")
{
  // A motion extrapolated with constant velocity would show the fluid no acceleration at all: no load, a run that looks
  // healthy and is wrong.
  for (const std::string scheme : {"css_parallel", "gss", "iss", "explicit_lagfree", "cibc"}) {
    CAPTURE(scheme);
    auto run = wall_run(750.0, {});
    run.sets = {"driver.scheme=" + scheme};

    const RunFolder folder;
    const auto result = folder.run(run);

    CHECK(result.exit_code == 2);
    CHECK(has(result.err, "[driver] knows no key 'motion'"));
  }
  auto predicted = css_run(750.0);
  predicted.sets.emplace_back("driver.predictor=linear");
  const RunFolder folder;
  CHECK(folder.run(predicted).exit_code == 2);
}

TEST_CASE("what has not converged is never taken for a result")
{
  const auto diverged = refused(1.1, {"driver.acceleration=constant", "driver.relaxation=1"});
  CHECK(diverged.exit_code == 1);
  CHECK_MESSAGE(has(diverged.err, "has diverged"), diverged.err);
  CHECK_MESSAGE(has(diverged.err, "the displacement changed by"), diverged.err);

  const auto stopped = refused(750.0, {"driver.max_iterations=2"});
  CHECK(stopped.exit_code == 1);
  CHECK_MESSAGE(has(stopped.err, "has not converged after 2 iterations"), stopped.err);
  CHECK_MESSAGE(has(stopped.err, "accept_with_warning"), stopped.err); // what to do

  const RunFolder folder;
  const auto accepted =
      folder.run(wall_run(750.0, {"driver.max_iterations=2", "driver.on_not_converged=accept_with_warning"}));
  CHECK(accepted.exit_code == 0);
  CHECK(last_step(folder / "out") == 50);
  CHECK_MESSAGE(has(accepted.err, "has not converged after 2 iterations"), accepted.err);
  CHECK_MESSAGE(has(accepted.err, "warning"), accepted.err);
}

TEST_CASE("strong coupling gives the same bytes inline, in processes, replayed and amnesiac, with every acceleration")
{
  for (const Sets& sets :
       {Sets{"driver.acceleration=constant", "driver.relaxation=0.2"}, Sets{"driver.acceleration=aitken"}, Sets{},
        Sets{"driver.iteration=parallel"}, Sets{"driver.acceleration=iqn_mvj"}}) {
    CAPTURE(fmt::format("{}", fmt::join(sets, " ")));
    const RunFolder folder;
    auto run = wall_run(10.0, sets);
    run.sets.insert(run.sets.end(), {"run.end_time=0.0012", "output.every=3"});
    run.out = "reference";
    const auto reference = folder.run(run);
    REQUIRE_MESSAGE(reference.exit_code == 0, reference.err);
    REQUIRE(last_step(folder / "reference") == 12);

    run.out = "out";
    for (const Sets& flags : {Sets{"--processes"}, Sets{"--inline", "--replay"}, Sets{"--amnesia", "1"}}) {
      CAPTURE(flags.back());
      run.flags = flags;
      const auto result = folder.run(run);
      CHECK_MESSAGE(result.exit_code == 0, result.err);
      CHECK(difference(folder / "out", folder / "reference") == "");
    }
  }
}
