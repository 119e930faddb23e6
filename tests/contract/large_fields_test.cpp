// Large fields are checked for finite values beside the run, while the next module works. Nothing else may show of
// that: the same bytes, the same culprit, and no step committed whose values were not all found finite.
#include "support/faulty_piston.hpp"
#include "support/run_case.hpp"

#include "shm/levels.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

namespace {

constexpr int nodes = 200'000;
static_assert(3 * sizeof(double) * nodes >= mullion::shm::large_field_bytes);

/// Structure, then fluid, five steps; large or small.
CaseRun exchange(int n_nodes, const std::vector<std::string>& sets, const std::vector<std::string>& flags)
{
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/cli/good_case.toml";
  run.sets = {"run.end_time=0.05", "output.every=5", "fluid.nodes=" + std::to_string(n_nodes),
              "structure.nodes=" + std::to_string(n_nodes)};
  run.sets.insert(run.sets.end(), sets.begin(), sets.end());
  run.flags = flags;
  return run;
}

const std::vector<std::vector<std::string>> ways = {{"--inline"},
                                                    {"--processes"},
                                                    {"--inline", "--replay"},
                                                    {"--processes", "--replay"},
                                                    {"--processes", "--amnesia", "2"}};

/// One message, that of the step 3; what was committed before stays, and nothing of the step itself.
void check_ended_in_step_3(const RunFolder& folder, const ProcessResult& result, const std::vector<std::string>& parts)
{
  CAPTURE(result.err);
  CHECK(result.exit_code == 1);
  const auto messages = error_messages(result);
  REQUIRE(messages.size() == 1);
  for (const auto& part : parts) CHECK_MESSAGE(has(messages[0], part), part);
  CHECK(has(messages[0], " failed in step, step 3, t = 0.02 s: "));
  CHECK(last_step(folder / "out") == 2);
  check_nothing_left(folder);
}

const std::string structure = "module 'structure' (trivial_structure, ", fluid = "module 'fluid' (trivial_fluid, ";

std::string last_of(const std::string& field, int n_nodes)
{
  return field + "[2, " + std::to_string(n_nodes - 1) + "] = nan (component, entity): not a finite number";
}

} // namespace

TEST_CASE("large fields give the same bytes inline, in processes, replayed and amnesiac")
{
  const RunFolder folder;
  auto reference = exchange(nodes, {}, {"--inline"});
  reference.out = "reference";
  REQUIRE(folder.run(reference).exit_code == 0);

  for (const auto& flags : ways) {
    CAPTURE(flags.front());
    CAPTURE(flags.back());
    const auto result = folder.run(exchange(nodes, {}, flags));
    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    CHECK(difference(folder / "out", folder / "reference") == "");
  }
}

TEST_CASE("a NaN that the last call of a step writes is named and the step is not committed, in small fields and large")
{
  for (const int n : {20, nodes})
    for (const auto& flags : ways) {
      CAPTURE(n);
      CAPTURE(flags.front());
      CAPTURE(flags.back());
      const RunFolder folder;

      const auto result = folder.run(exchange(n, {"fluid.not_finite_in=3"}, flags));

      check_ended_in_step_3(folder, result, {fluid, last_of("fluid/wall.traction", n)});
    }
}

TEST_CASE("where a NaN makes the next module write another, throw or die, the first writer is named")
{
  for (const int n : {20, nodes})
    for (const char* on_nan : {"compute", "throw", "abort"})
      for (const std::vector<std::string>& sets : {std::vector<std::string>{},
                                                   {"fluid.process=true"},
                                                   {"structure.process=true"},
                                                   {"fluid.process=true", "structure.process=true"}}) {
        const bool is_fluid_inline = sets.empty() || sets[0] != "fluid.process=true";
        if (is_fluid_inline && on_nan == std::string("abort")) continue; // it takes the orchestrator with it
        CAPTURE(n);
        CAPTURE(on_nan);
        CAPTURE(sets.size());
        CAPTURE(is_fluid_inline);
        const RunFolder folder;
        auto run = exchange(n, {"structure.not_finite_in=3", std::string("fluid.on_nan=") + on_nan}, {});
        run.sets.insert(run.sets.end(), sets.begin(), sets.end());

        const auto result = folder.run(run);

        check_ended_in_step_3(folder, result, {structure, last_of("structure/wet.velocity", n)});
      }
}

TEST_CASE("a death that a NaN caused is not a reason to do the step again")
{
  const RunFolder folder;

  const auto result = folder.run(
      exchange(nodes, {"structure.not_finite_in=3", "fluid.on_nan=abort", "run.on_failure=respawn"}, {"--processes"}));

  check_ended_in_step_3(folder, result, {structure, last_of("structure/wet.velocity", nodes)});
}

TEST_CASE("a NaN is found before the next iteration writes over it")
{
  for (const int n : {20, nodes})
    for (const auto& flags : ways) {
      CAPTURE(n);
      CAPTURE(flags.front());
      CAPTURE(flags.back());
      const RunFolder folder;

      const auto result = folder.run(
          exchange(n, {"structure.not_finite_in=3", "driver.scheme=calls_driver", "driver.iterations=3"}, flags));

      check_ended_in_step_3(folder, result, {structure, last_of("structure/wet.velocity", n)});
    }
}
