// history.csv: what is in it, that numbers read back exactly, going on after a restart, disks that run full.
#include "io/history_writer.hpp"

#include "io/atomic_file.hpp"
#include "scratch.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>

using namespace mullion;
using namespace mullion::io;
using mullion::testing::Scratch;

TEST_CASE("a history has a header and a line per step")
{
  const Scratch scratch;
  HistoryWriter history(scratch / "history.csv", {"force", "fluid.energy"});
  const double values[] = {0.1, -2.5e-7};

  history.row(0, 0.0, values);
  history.row(1, 1e-5, values);
  history.close();

  CHECK(read_text(scratch / "history.csv") == "step,time,force,fluid.energy\n0,0,0.1,-2.5e-07\n1,1e-05,0.1,-2.5e-07\n");
}

TEST_CASE("every finite double of a history reads back to the same bits")
{
  const Scratch scratch;
  std::vector<double> values{-0.0, 1e308, std::numeric_limits<double>::denorm_min(), 0.1, 1.0 / 3.0};
  std::mt19937_64 random(1);
  while (values.size() < 2000)
    if (const auto v = std::bit_cast<double>(random()); std::isfinite(v)) values.push_back(v);
  HistoryWriter history(scratch / "history.csv", {"x"});
  for (const double& v : values) history.row(1, v, {&v, 1});
  history.close();

  std::ifstream file(scratch / "history.csv");
  std::string line;
  std::getline(file, line);
  std::size_t n_same = 0;
  for (const double v : values) {
    std::getline(file, line);
    const auto comma = line.rfind(',');
    const double time = std::strtod(line.c_str() + 2, nullptr), value = std::strtod(line.c_str() + comma + 1, nullptr);
    if (std::bit_cast<std::uint64_t>(time) == std::bit_cast<std::uint64_t>(v) &&
        std::bit_cast<std::uint64_t>(value) == std::bit_cast<std::uint64_t>(v))
      ++n_same;
  }
  CHECK(n_same == values.size());
}

TEST_CASE("a new history replaces an old one, and a history can do without columns")
{
  const Scratch scratch;
  std::ofstream(scratch / "history.csv") << "a long text from an earlier run\n";

  HistoryWriter history(scratch / "history.csv", {});
  history.row(3, 0.5, {});
  history.close();

  CHECK(read_text(scratch / "history.csv") == "step,time\n3,0.5\n");
}

TEST_CASE("a restarted history keeps the lines up to its step and drops later and broken ones")
{
  const Scratch scratch;
  std::ofstream(scratch / "history.csv") << "step,time,x\n0,0,1\n1,0.1,2\n2,0.2,3\n3,0.3";
  const double x = 9.0;

  {
    HistoryWriter history(scratch / "history.csv", {"x"}, 1);
    history.row(2, 0.2, {&x, 1});
  } // the destructor writes what is buffered
  CHECK(read_text(scratch / "history.csv") == "step,time,x\n0,0,1\n1,0.1,2\n2,0.2,9\n");

  HistoryWriter(scratch / "history.csv", {"x"}, 100).close();
  CHECK(read_text(scratch / "history.csv") == "step,time,x\n0,0,1\n1,0.1,2\n2,0.2,9\n");
}

TEST_CASE("a restarted history without a file starts anew, one with other columns is an error")
{
  const Scratch scratch;

  HistoryWriter(scratch / "history.csv", {"x"}, 5).close();
  CHECK(read_text(scratch / "history.csv") == "step,time,x\n");
  CHECK_THROWS_WITH_AS(HistoryWriter(scratch / "history.csv", {"y"}, 5),
                       doctest::Contains("columns are 'step,time,x' but this run's are 'step,time,y'"), Error);
}

TEST_CASE("a full disk is an error that names the file")
{
  HistoryWriter history("/dev/full", {"x"});
  const double x = 1.0;

  // the first row is written at once
  CHECK_THROWS_WITH_AS(history.row(0, 0.0, {&x, 1}),
                       doctest::Contains("cannot write /dev/full: No space left on device"), Error);
  CHECK_NOTHROW(history.close());
  CHECK_THROWS_AS(HistoryWriter("/nowhere/history.csv", {}), Error);
}
