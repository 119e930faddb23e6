// What the transfers cost: building the operators and applying them (traction to loads, loads to traction, motion), and
// peak memory (without the fluid's mass matrix, which adjoint motion needs), for triangles on a wing, N nodes onto 0.7
// N others, 1e3 to 1e6, every method. Processor time; each line in a process of its own, so that peaks are its own.
// Growth is the order in N of the building since the size before.
//
//   build-dev/bench/transfer_methods [--rounds R] [--largest N]
#include "support/overlay_meshes.hpp"
#include "surface/integration_points.hpp"
#include "surface/overlay_operators.hpp"
#include "surface/surface_overlay.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <functional>
#include <map>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace {

using namespace mullion::testing;
using namespace mullion::surface;

double processor_seconds()
{
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

TransferOperators build(const std::string& method, const SurfaceMesh& source, const SurfaceMesh& target)
{
  const FaceTree tree(target);
  if (method == "nearest neighbour")
    return operators_of_projection(source, target, nearest_nodes(source, target), Location::nodes,
                                   SourceMass::left_out);
  if (method == "node projection")
    return operators_of_projection(source, target, node_projection(source, target, tree), Location::nodes,
                                   SourceMass::left_out);
  if (method == "quadrature projection, 2 points")
    return operators_of_points(source, target, tree, quadrature_points(source, target, tree, {.n_points = 2}),
                               Location::nodes, MassMetric::native, SourceMass::left_out);
  OverlayAssembly assembly(source, target, Location::nodes, Metric::source, MassMetric::same, SourceMass::left_out);
  (void)overlay_surfaces(source, target, {}, [&](const Subelement& piece) { assembly.add(piece); });
  return assembly.finish(tree);
}

struct Cost {
  double build, load, recover, motion, peak_megabytes;
};

Cost cost(const std::string& method, long n_nodes, int rounds)
{
  const int n = static_cast<int>(std::sqrt(static_cast<double>(n_nodes))) - 1;
  const int k = static_cast<int>(std::sqrt(0.7 * static_cast<double>(n_nodes))) - 1;
  const auto source = grid_on(wing, {n, n, Faces::triangles, 0.24, 1, 1});
  const auto target = turned_over(grid_on(wing, {k, k, Faces::triangles, 0.24, 2, 1}));
  std::vector<double> builds, loads, recoveries, motions;
  for (int r = 0; r < rounds; ++r) {
    double begin = processor_seconds();
    const auto operators = build(method, source, target);
    builds.push_back(processor_seconds() - begin);
    const Field traction = Field::Ones(3, source.n_nodes()), motion = Field::Ones(3, target.n_nodes());
    for (int i = 0; i < 5; ++i) {
      begin = processor_seconds();
      const Field load = loads_from_traction(operators, traction);
      loads.push_back(processor_seconds() - begin);
      begin = processor_seconds();
      const Field recovered = recover(operators.target_mass, load, Recovery::consistent);
      recoveries.push_back(processor_seconds() - begin);
      begin = processor_seconds();
      const Field moved = motion_of_source(operators, motion, Motion::interpolate);
      motions.push_back(processor_seconds() - begin);
      if (!(recovered.sum() + moved.sum() > 0.0)) std::abort(); // there is something to measure
    }
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return {median(builds), median(loads), median(recoveries), median(motions),
          static_cast<double>(usage.ru_maxrss) / 1024.0};
}

/// In a process of its own.
Cost apart(const std::string& method, long n_nodes, int rounds)
{
  int ends[2];
  if (::pipe(ends) != 0) std::abort();
  std::fflush(stdout);
  const pid_t pid = ::fork();
  if (pid == 0) {
    const Cost found = cost(method, n_nodes, rounds);
    const bool is_written = ::write(ends[1], &found, sizeof found) == sizeof found;
    ::_exit(is_written ? 0 : 1);
  }
  Cost found{};
  int status = 0;
  ::waitpid(pid, &status, 0);
  if (status != 0 || ::read(ends[0], &found, sizeof found) != sizeof found) {
    fmt::print(stderr, "{} with {} nodes failed\n", method, n_nodes);
    std::exit(1);
  }
  ::close(ends[0]), ::close(ends[1]);
  return found;
}

} // namespace

int main(int argc, char** argv)
{
  int rounds = 3;
  long largest = 1'000'000;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--largest") == 0) largest = std::atol(argv[i + 1]);
  }
  fmt::print("{:<34} {:>9} {:>10} {:>7} {:>10} {:>12} {:>10} {:>9}\n", "", "nodes", "build s", "growth", "load ms",
             "recovery ms", "motion ms", "peak MB");
  for (const std::string method :
       {"nearest neighbour", "node projection", "quadrature projection, 2 points", "common refinement"}) {
    double before = 0.0;
    for (long n_nodes = 1000; n_nodes <= largest; n_nodes *= 10) {
      const auto c = apart(method, n_nodes, n_nodes >= 1'000'000 ? 1 : rounds);
      fmt::print("{:<34} {:>9} {:>10.4f} {:>7.2f} {:>10.3f} {:>12.3f} {:>10.3f} {:>9.0f}\n", method, n_nodes, c.build,
                 before > 0.0 ? std::log10(c.build / before) : 0.0, 1e3 * c.load, 1e3 * c.recover, 1e3 * c.motion,
                 c.peak_megabytes);
      std::fflush(stdout);
      before = c.build;
    }
  }
}
