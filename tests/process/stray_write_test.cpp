// A module in a process of its own that writes where it may only read faults by itself: the run names it and the
// window, and the data of all the others are whole, to the byte, up to the last commit.
#include "support/faulty_piston.hpp"

#include <doctest/doctest.h>

#include <string>

using namespace mullion;

namespace {

void check_stray_write(const std::string& fault, const std::string& window, const std::string& others)
{
  CAPTURE(fault);
  const test::RunFolder folder;
  auto clean = test::piston({}, {"--inline"});
  clean.out = "clean";
  REQUIRE(folder.run(clean).exit_code == 0);

  auto run = test::piston({"structure.fault=" + fault, "structure.at_step=37"});
  for (const char* instance : {"fluid", "mesh_motion", "transfer"})
    run.sets.push_back(std::string(instance) + ".process=" + others);
  const auto result = folder.run(run);

  test::check_failed(folder, result, 1,
                     {"module 'structure' (faulty_structure, process ",
                      "was killed by signal 11 (SIGSEGV) after a write into the read-only window " + window +
                          ", which another party owns",
                      "in step, step 37"});
  CHECK(test::last_step(folder / "out") == 36);
  CHECK(test::difference_of_part(folder / "out", folder / "clean") == "");
  CHECK(std::filesystem::exists(folder / "out/results/000000030.h5"));
  CHECK(!std::filesystem::exists(folder / "out/results/000000040.h5"));
}

} // namespace

TEST_CASE("a stray write into a received field faults in the offender, and the data are whole")
{
  check_stray_write("stray_write", "structure/wet.in", "true");
  check_stray_write("stray_write", "structure/wet.in", "false");
}

TEST_CASE("a stray write into another module's window faults in the offender, and the data are whole")
{
  check_stray_write("stray_write_peer", "fluid/wall", "true");
  check_stray_write("stray_write_peer", "fluid/wall", "false"); // the fluid in the orchestrator: no difference
}
