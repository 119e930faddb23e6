// The mesh motions as modules, in runs whose wall moves as prescribed: the mesh comes back with its wall, every
// placement gives the same bytes, a mesh that gets poor is warned of, and one that would fold ends the run first.
#include "support/history.hpp"
#include "support/run_case.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

using namespace mullion::test;

namespace {

CaseRun arch_run(std::vector<std::string> sets, std::vector<std::string> flags = {"--inline"})
{
  CaseRun run;
  run.file = MULLION_SOURCE_DIR "/tests/verification/moving_mesh.toml";
  run.sets = std::move(sets);
  run.flags = std::move(flags);
  return run;
}

/// A cube whose floor is pushed up by this many metres a second.
CaseRun cube_run(const std::string& cells, const std::string& velocity, const std::string& slide)
{
  return arch_run({"fluid.mesh=box:4x4x4," + cells, "fluid.wall=z_min", "structure.mesh=rectangle:5x5",
                   "structure.group=", "structure.velocity=0; 0; " + velocity, "structure.function=0; 0; 0",
                   "mesh_motion.slide=" + slide});
}

int count(const std::string& text, const std::string& part)
{
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

} // namespace

TEST_CASE("after a cycle of its wall the mesh is back, and was squeezed less as an elastic body")
{
  double smallest[2];
  for (const bool is_elastic : {false, true}) {
    const RunFolder folder;

    const auto result =
        folder.run(arch_run({std::string("mesh_motion.module=") + (is_elastic ? "elastic_mesh" : "laplacian")}));

    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    const auto history = read_history(folder / "out/history.csv");
    const auto& distance = history.at("fluid.volume.distance");
    const auto& ratio = history.at("mesh_motion.volume.min_area_ratio");
    // The highest point: sum of 25 cosines at the middles of the steps, 0.05 pi / 50 / sin(pi / 100) = 0.050008.
    CHECK(distance[25] == doctest::Approx(0.050008).epsilon(1e-4)); // the wall's nodes lie beside the arch's by 1e-5
    CHECK(distance.back() < 1e-14);                                 // a hundred roundings of numbers below 0.2
    CHECK(std::abs(ratio.back() - 1.0) < 1e-12);
    smallest[is_elastic ? 1 : 0] = *std::min_element(ratio.begin(), ratio.end());
    CHECK(*std::min_element(ratio.begin(), ratio.end()) == ratio[25]);
  }
  CHECK(smallest[0] > 0.4);
  CHECK(smallest[1] > smallest[0] + 0.05);
}

TEST_CASE("a mesh motion gives the same bytes inline, in a process, replayed and by fresh processes")
{
  for (const char* module : {"laplacian", "elastic_mesh"}) {
    const std::vector<std::string> sets = {std::string("mesh_motion.module=") + module, "run.end_time=0.1",
                                           "output.every=5"};
    const RunFolder inline_run, processes, replay, amnesia;
    REQUIRE(inline_run.run(arch_run(sets)).exit_code == 0);
    REQUIRE(processes.run(arch_run(sets, {"--processes"})).exit_code == 0);
    REQUIRE(replay.run(arch_run(sets, {"--inline", "--replay"})).exit_code == 0);
    REQUIRE(amnesia.run(arch_run(sets, {"--amnesia", "4"})).exit_code == 0);

    for (const auto* other : {&processes, &replay, &amnesia})
      CHECK(difference(*other / "out", inline_run / "out") == "");
  }
}

TEST_CASE("between a moving floor and sides along which it slides, a mesh in space is squeezed evenly")
{
  for (const char* cells : {"hexes", "tets"}) {
    const RunFolder folder;

    const auto result = folder.run(cube_run(cells, "0.4", "x_min, x_max, y_min, y_max"));

    REQUIRE_MESSAGE(result.exit_code == 0, result.err);
    const auto history = read_history(folder / "out/history.csv");
    CHECK(history.at("mesh_motion.volume.min_area_ratio").back() == doctest::Approx(0.6).epsilon(1e-12)); // 1 s
    CHECK(history.at("fluid.volume.distance").back() == doctest::Approx(0.4).epsilon(1e-12));
  }
}

TEST_CASE("a mesh that gets poor is warned of once, and the run ends before an element folds, with its place")
{
  const RunFolder folder;

  const auto result = folder.run(cube_run("hexes", "0.4", ""));

  CHECK(result.exit_code == 1);
  CHECK_MESSAGE(count(result.err, "of its reference size, below 0.2") == 1, result.err);
  CHECK_MESSAGE(count(result.err, "the mesh would fold by t = 0.63 s: element 0 around (0.125, 0.125, ") == 1,
                result.err);
  CHECK(count(result.err, "(in the reference mesh (0.125, 0.125, 0.125)), where a corner has -") == 1);
  // The floor's edge reaches the next nodes of the sides, which stay at 0.25 m, after 0.625 s. No step was taken with a
  // folded mesh.
  const auto history = read_history(folder / "out/history.csv");
  CHECK(history.at("time").back() == doctest::Approx(0.62));
  CHECK(history.at("mesh_motion.volume.min_area_ratio").back() > 0.0);
}

TEST_CASE("sides that do not exist, have no face or are named twice are mistakes of the case")
{
  const RunFolder folder;
  const auto unknown = folder.run(arch_run({"mesh_motion.slide=x_min, left"}));
  CHECK(unknown.exit_code == 2);
  CHECK_MESSAGE(
      count(unknown.err, "slide = \"x_min, left\": \"left\" is no side; there are x_min, x_max, y_min, y_max") == 1,
      unknown.err);

  auto run = arch_run({"mesh_motion.slide=x_max", "fluid.mesh=cook:4x4", "fluid.wall=left",
                       "structure.mesh=line:4,to=0:44", "structure.group="});
  run.out = "cook";
  CHECK(folder.run(run).exit_code == 0); // its right side is one

  run.sets.front() = "mesh_motion.slide=y_min";
  run.out = "cook_floor";
  const auto empty = folder.run(run);
  CHECK(empty.exit_code == 2);
  CHECK_MESSAGE(count(empty.err, "slide = \"y_min\": no face of the boundary lies on y_min") == 1, empty.err);

  const auto twice = folder.run(arch_run({"mesh_motion.slide=x_min", "mesh_motion.free=x_max, x_min"}));
  CHECK(twice.exit_code == 2);
  CHECK_MESSAGE(count(twice.err, "side x_min is named twice, in slide = \"x_min\" and free = \"x_max, x_min\"") == 1,
                twice.err);
}
