// How many evaluations each acceleration needs for the fixed point of a linear map, against theory, and what a step
// hands down to the next. The map belongs to the test driver fixed_point, which also checks the solution; the count is
// the column driver.iterations.
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

namespace {

/// 2 nodes: x has 6 entries, 12 with both fields.
ProcessResult run_fixed_point(const RunFolder& folder, const std::vector<std::string>& options,
                              const std::string& end_time = "0.03", const std::string& flag = "--inline")
{
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/cli/good_case.toml";
  run.sets = {"driver.scheme=fixed_point", "fluid.nodes=2", "structure.nodes=2", "output.every=0", "run.dt=0.01",
              "run.end_time=" + end_time};
  for (const auto& option : options) run.sets.push_back("driver." + option);
  run.flags = {flag};
  return folder.run(run);
}

/// Evaluations in each step.
std::vector<double> iterations(const std::vector<std::string>& options, const std::string& end_time = "0.03",
                               const std::string& flag = "--inline")
{
  const RunFolder folder;
  const auto result = run_fixed_point(folder, options, end_time, flag);
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  auto counts = read_history(folder / "out/history.csv").at("driver.iterations");
  counts.erase(counts.begin()); // the row of the initial state
  return counts;
}

using Counts = std::vector<double>;

} // namespace

TEST_CASE("constant relaxation shrinks the residual by 1 - theta (1 - a) in each iteration")
{
  // a = -1, theta = 0.3: a factor 0.4; 0.4^22 = 1.8e-9, 0.4^23 = 7.0e-10, so 23 steps of x and 24 evaluations
  CHECK(iterations({"method=constant", "map=multiple", "relaxation=0.3"}) == Counts{24, 24, 24});
  // theta = 1 / (1 - a): the first x is the solution
  CHECK(iterations({"method=constant", "map=multiple", "relaxation=0.5"}) == Counts{2, 2, 2});
}

TEST_CASE("Aitken's factor is exact after two residuals where all of them are parallel, and starts anew in each step")
{
  CHECK(iterations({"method=aitken", "map=multiple", "relaxation=0.3"}) == Counts{3, 3, 3});
  CHECK(iterations({"method=aitken", "map=multiple", "relaxation=-0.7"}) == Counts{3, 3, 3}); // any sign will do
}

TEST_CASE("Aitken's factor needs no more evaluations than the best constant one, and none at all diverges")
{
  // The eigenvalues of I - A lie between 2 and 3.7: the best constant theta, 2 / 5.7, shrinks the residual to 0.30 in
  // each iteration, so that 1e-9 takes 18 of them and 19 evaluations. theta = 1 diverges.
  const RunFolder folder;
  CHECK(run_fixed_point(folder, {"method=constant", "map=spread", "relaxation=1.0"}).exit_code == 1);
  for (const double count : iterations({"method=aitken", "map=spread", "relaxation=0.3"})) CHECK(count <= 19);
}

TEST_CASE("IQN-ILS finds the fixed point of a linear map in as many evaluations as it has unknowns, and two")
{
  // One relaxed step, then each evaluation adds a column; n of them span the space, and the next x is the solution.
  const auto one_field = iterations({"method=iqn_ils", "reuse=0"});
  const auto two_fields = iterations({"method=iqn_ils", "reuse=0", "two_fields=true"});

  CHECK(one_field == Counts{8, 8, 8});
  CHECK(two_fields == Counts{14, 14, 14});
}

TEST_CASE("fields of very different size are weighted, so that neither is forgotten")
{
  CHECK(iterations({"method=iqn_ils", "reuse=0", "two_fields=true", "scale=1e8"}) == Counts{14, 14, 14});
  CHECK(iterations({"method=iqn_mvj", "two_fields=true", "scale=1e-8"})[0] == 14);
}

TEST_CASE("what a step has learnt of the map, the next ones use: columns with IQN-ILS, the Jacobian with IQN-MVJ")
{
  CHECK(iterations({"method=iqn_ils", "reuse=2"}) == Counts{8, 2, 2});
  CHECK(iterations({"method=iqn_mvj"}) == Counts{8, 2, 2});
}

TEST_CASE("what was learnt survives a fresh process and a step done twice")
{
  for (const std::string method : {"iqn_ils", "iqn_mvj"})
    for (const std::string flag : {"--replay", "--amnesia=1"})
      CHECK(iterations({"method=" + method}, "0.03", flag) == Counts{8, 2, 2});
}

TEST_CASE("a step whose size differs by more than a factor of two starts without what was learnt")
{
  for (const std::string method : {"iqn_ils", "iqn_mvj"}) {
    CAPTURE(method);
    CHECK(iterations({"method=" + method}, "0.026") == Counts{8, 2, 2}); // the last step: 0.6 dt
    CHECK(iterations({"method=" + method}, "0.024") == Counts{8, 2, 8}); // 0.4 dt
  }
}

TEST_CASE("a field without any residual at the start, as from rest, doesn't drown the other one for the step")
{
  // Both at rest: the structure's first residual is exactly zero. Were it counted in the weights, the first step would
  // not converge in 100 iterations; it takes a handful.
  const RunFolder folder;
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/verification/added_mass.toml";
  run.sets = {"structure.density=750", "driver.iteration=parallel", "driver.motion_floor=0", "driver.traction_floor=0",
              "output.every=0",        "run.end_time=3e-4"};
  run.flags = {"--inline"};

  const auto result = folder.run(run);

  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  const auto history = read_history(folder / "out/history.csv");
  for (const double count : history.at("driver.iterations")) CHECK(count <= 10);
}
