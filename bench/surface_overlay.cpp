// What the overlay of two surfaces costs: triangles on a wing, N nodes onto 0.7 N others, shifted at random, from 1e3
// to 1e6 nodes; processor time and peak memory, with the meshes and without. Growth is the time's order in N since the
// line above: 1.0 to 1.1 is N log N. Each size in a process of its own, so that peaks are its own.
//
//   build-dev/bench/surface_overlay [--rounds R] [--largest N] [--operators]
//
// --operators: also the load operator and the target's mass from the overlay, with all pieces and points in memory.
#include "surface/surface_overlay.hpp"
#include "support/overlay_meshes.hpp"
#include "surface/integration_points.hpp"
#include "surface/operators.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace {

using namespace mullion::testing;
using namespace mullion::surface;

/// Processor time: a busy machine does not count.
double processor_seconds()
{
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double peak_megabytes()
{
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

struct Cost {
  long n_pieces;
  double seconds, mesh_megabytes, peak_megabytes;
};

Cost cost(long n_nodes, int rounds, bool with_operators)
{
  const int n = static_cast<int>(std::sqrt(static_cast<double>(n_nodes))) - 1;
  const int k = static_cast<int>(std::sqrt(0.7 * static_cast<double>(n_nodes))) - 1;
  const auto source = grid_on(wing, {n, n, Faces::triangles, 0.24, 1, 1});
  const auto target = turned_over(grid_on(wing, {k, k, Faces::triangles, 0.24, 2, 1}));
  Cost result{0, 0.0, peak_megabytes(), 0.0};
  std::vector<double> seconds;
  for (int r = 0; r < rounds; ++r) {
    const double begin = processor_seconds();
    std::vector<Subelement> pieces;
    result.n_pieces = 0;
    overlay_surfaces(source, target, {}, [&](const Subelement& piece) {
      ++result.n_pieces;
      if (with_operators) pieces.push_back(piece);
    });
    if (with_operators) {
      const auto set = points_of_overlay(source, target, pieces, Metric::source);
      const auto load = load_operator(source, target, set.points, Location::nodes);
      const auto mass = target_mass(target, set.points);
      if (load.nonZeros() + mass.nonZeros() == 0) std::abort(); // there is something to measure
    }
    seconds.push_back(processor_seconds() - begin);
  }
  std::sort(seconds.begin(), seconds.end());
  result.seconds = seconds[seconds.size() / 2];
  result.peak_megabytes = peak_megabytes();
  return result;
}

/// The same in a process of its own.
Cost cost_alone(long n_nodes, int rounds, bool with_operators)
{
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  std::fflush(stdout); // or the child prints it again
  const pid_t child = ::fork();
  if (child == 0) {
    const Cost result = cost(n_nodes, rounds, with_operators);
    ::_exit(::write(ends[1], &result, sizeof result) == sizeof result ? 0 : 1);
  }
  Cost result{};
  const bool is_read = ::read(ends[0], &result, sizeof result) == sizeof result;
  int status = 0;
  ::waitpid(child, &status, 0);
  ::close(ends[0]);
  ::close(ends[1]);
  if (!is_read || status != 0) std::abort();
  return result;
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 3;
  long largest = 1'000'000;
  bool with_operators = false;
  for (int i = 1; i < argc; ++i) {
    if (std::strcmp(argv[i], "--operators") == 0) with_operators = true;
    if (i + 1 < argc && std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (i + 1 < argc && std::strcmp(argv[i], "--largest") == 0) largest = std::atol(argv[i + 1]);
  }
  fmt::print("{:>9} {:>9} {:>9} {:>8} {:>10} {:>10}\n", "nodes", "pieces", "s", "growth", "meshes MB", "peak MB");
  double last_seconds = 0.0, last_nodes = 0.0;
  for (long n = 1000; n <= largest; n *= 10) {
    const Cost c = cost_alone(n, rounds, with_operators);
    const double nodes = static_cast<double>(n);
    const double growth = last_seconds > 0.0 ? std::log(c.seconds / last_seconds) / std::log(nodes / last_nodes) : 0.0;
    fmt::print("{:>9} {:>9} {:>9.4f} {:>8.2f} {:>10.0f} {:>10.0f}\n", n, c.n_pieces, c.seconds, growth,
               c.mesh_megabytes, c.peak_megabytes);
    last_seconds = c.seconds;
    last_nodes = nodes;
  }
}
