// The uniform state behind the superseismic shock, gas that slips over a strained solid, with three transfers. On
// matching flat sides of different meshes it is exact; it is unstable, so that whatever a transfer adds grows for 60
// us.
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace mullion::test;

namespace {

/// Standard deviation over mean of the pressure along the interface after 60 us.
double scatter(const std::vector<std::string>& sets)
{
  const RunFolder folder;
  const auto result = folder.run({.file = MULLION_SOURCE_DIR "/configs/paper/superseismic_sliding.toml",
                                  .sets = sets,
                                  .flags = {"--inline"},
                                  .timeout = std::chrono::minutes(25)});
  REQUIRE_MESSAGE(result.exit_code == 0, result.err);
  const auto history = read_history(folder / "out" / "history.csv");
  return history.at("fluid.wall.pressure.deviation").back() / history.at("fluid.wall.pressure.mean").back();
}

} // namespace

TEST_SUITE("full")
{
  TEST_CASE("common refinement keeps the uniform sliding state, and no projection does")
  {
    // Observed 4.8e-14: 1e-15 at first, times what 60 us of growth make of it. 1e-8 is what another implementation was
    // held to; no more is needed to tell it from the others.
    CHECK(scatter({"output.every=0"}) < 1e-8);
    // So the check above can fail. Observed 0.26 and 0.21.
    CHECK(scatter({"output.every=0", "transfer.module=node_projection"}) > 0.05);
    CHECK(scatter({"output.every=0", "transfer.module=quadrature_projection", "transfer.points=2"}) > 0.05);
  }
}
