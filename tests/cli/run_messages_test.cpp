// What a user reads when a scheme finds, in a run, that it cannot go on: the reason, with numbers, and what to change.
// (What is wrong before anything runs: check_test.cpp.)
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

namespace {

const std::string piston = "configs/closed_piston.toml", added_mass = "tests/verification/added_mass.toml";

/// An inline run of 40 steps or 50, without result files.
ProcessResult run_inline(const std::string& file, std::vector<std::string> sets)
{
  const RunFolder folder;
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/" + file;
  run.sets = std::move(sets);
  run.sets.emplace_back("output.every=0");
  if (file == piston) run.sets.insert(run.sets.begin(), "run.end_time=2.4377976008801763e-4");
  run.flags = {"--inline"};
  return folder.run(run);
}

/// cibc on the piston, whose c dt/dx is 0.1 and whose sound speed is 328.165 m/s.
ProcessResult run_cibc(std::vector<std::string> sets)
{
  for (const char* set : {"driver.scheme=cibc", "driver.fluid_density=1.3", "driver.sound_speed=328.165"})
    sets.insert(sets.begin(), set);
  return run_inline(piston, std::move(sets));
}

int count(const std::string& text, const std::string& part)
{
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

/// The result ends with this message.
void check_message(const ProcessResult& result, int exit_code, const std::string& message)
{
  CHECK(result.exit_code == exit_code);
  CHECK_MESSAGE(count(result.err, "mullion: error: " + message) == 1, result.err);
}

} // namespace

TEST_CASE("explicit_lagfree names the structure whose displacement depends on the load, and what to use instead")
{
  for (const std::vector<std::string>& structure :
       {std::vector<std::string>{"structure.integrator=newmark"},
        {"structure.integrator=central_difference", "structure.substeps=2"}}) {
    auto sets = structure;
    sets.emplace_back("driver.scheme=explicit_lagfree");

    const auto result = run_inline(piston, sets);

    check_message(result, 2,
                  "explicit_lagfree needs a structure whose displacement at the end of a step does not "
                  "depend on that step's load; in step 1 (t = 0 s) 'structure' moved by 5.");
    CHECK(count(result.err,
                "where 5.714286e-07 m was certain beforehand. Use an explicit integrator "
                "(central_difference) without substeps, or another scheme") == 1); // dt^2 a / 2, a = dp / m_0
  }
}

TEST_CASE("cibc refuses a weight outside of its window with the bounds, and runs it with a warning where told to")
{
  // 1/2 + 4/3 0.1 = 0.6333; / 328.165 = 0.00193
  const std::string bounds = "wall point 0, t = 0 s: c dt/dx = 0.1, kappa = omega c = 2; admissible are 0 <= kappa <= "
                             "0.6333, that is 0 <= omega <= 0.00193 s/m";

  check_message(run_cibc({"driver.kappa=2"}), 2,
                "cibc: the weight is outside of its window at " + bounds +
                    " (omega_check = \"warn\" runs it all the same)");
  const auto warned = run_cibc({"driver.kappa=2", "driver.omega_check=warn", "run.end_time=2e-5"});
  CHECK(warned.exit_code == 0);
  CHECK(count(warned.err, "warning") == 1);
  CHECK(count(warned.err, "cibc: the weight is outside of its window at " + bounds) == 1);
}

TEST_CASE("cibc has a lower bound with the half offset, an upper one for printed, and warns of noise below c dt/dx")
{
  CHECK(count(run_cibc({"driver.kappa=0.005", "driver.half_offset=true"}).err, "admissible are 0.01 <= kappa <= inf") ==
        1);
  CHECK(run_cibc({"driver.kappa=20", "driver.half_offset=true"}).exit_code == 0);
  CHECK(count(run_cibc({"driver.kappa=0.5", "driver.reading=printed"}).err, "admissible are 0 <= kappa <= 0.2667") ==
        1);
  const auto low = run_cibc({"driver.kappa=0.05"});
  CHECK(low.exit_code == 0);
  CHECK(count(low.err, "below kappa = 0.1 grid-scale noise may grow") == 1);
}

TEST_CASE("cibc refuses steps beyond its Courant number with its way out")
{
  const auto result = run_cibc({"run.dt=2.4377976008801763e-5"}); // four times the step

  check_message(result, 2, "cibc: the weight is outside of its window at wall point 0, t = 0 s: c dt/dx = 0.4, ");
  CHECK(count(result.err, "with c dt/dx <= 0.3; take a smaller step, or half_offset = true, which has no such limit") ==
        1);
}

TEST_CASE("an explosion in a module is explained by the scheme")
{
  const auto result = run_cibc({"driver.kappa=2", "driver.omega_check=warn"});

  CHECK(result.exit_code == 1);
  CHECK_MESSAGE(count(result.err, "mullion: error: module 'fluid' (euler_1d, inline) failed in step, step ") == 1,
                result.err);
  CHECK(count(result.err, "(cibc is stable for weights within a window only") == 1);
}

TEST_CASE("a displacement beyond the limit ends the run, with the place and what the scheme knows of it")
{
  check_message(run_inline(added_mass, {"driver.scheme=css", "coupling.displacement_limit=1.0"}), 1,
                "the run diverges: in step 3, t = 0.0003");
  const auto result = run_inline(piston, {"coupling.displacement_limit=1e-5"});
  check_message(result, 1, "the run diverges: in step ");
  CHECK(count(result.err, "structure.wet.displacement[0, 0] = ") == 1);
  CHECK(count(result.err, "m (component, node) is beyond coupling.displacement_limit = 1e-05 m (css takes each solver "
                          "once a step: where the fluid's added mass outweighs the structure's it diverges at any step "
                          "size; the scheme \"strong\" iterates)") == 1);
  CHECK(run_inline(piston, {"coupling.displacement_limit=1.0"}).exit_code == 0);
}

TEST_CASE("strong says what has not converged, or warns and goes on where told to")
{
  const std::vector<std::string> sets = {"driver.scheme=strong", "driver.max_iterations=1"};
  auto accepting = sets;
  accepting.emplace_back("driver.on_not_converged=accept_with_warning");

  const auto failed = run_inline(piston, sets), accepted = run_inline(piston, accepting);

  check_message(failed, 1, "step 1 (t = 0 s) has not converged after 1 iterations: velocity changed by ");
  CHECK(count(failed.err, "allowed; allow more (max_iterations), or accept it (on_not_converged = "
                          "\"accept_with_warning\")") == 1);
  CHECK(accepted.exit_code == 0);
  CHECK(count(accepted.err, "strong: step 1 (t = 0 s) has not converged after 1 iterations") == 1);
}

TEST_CASE("an iteration that diverges within a step ends the run, naming the field and the entry")
{
  // added mass 68 times the wall's mass: the plain iteration grows by that factor
  const auto result = run_inline(added_mass, {"driver.acceleration=constant", "driver.relaxation=1.0"});

  check_message(result, 1, "the iteration has diverged: in step ");
  CHECK(count(result.err, "the displacement changed by ") == 1);
  CHECK(count(result.err, "a smaller relaxation, or acceleration = \"iqn_ils\", may help") == 1);
}
