// What a mesh motion costs: assembling and factoring once, then a solution, the quality of the mesh, and both in each
// step; a square of quadrilaterals, from 1e3 to 1e5 nodes, and a cube of hexahedra up to 2e4 (elastic: 6e3, the next
// one takes minutes to factor). Processor time. Growth is the order in the number of nodes since the line above.
//
//   build-dev/bench/mesh_motion [--largest N]
#include "files/generator_text.hpp"
#include "moving_mesh/motion_equations.hpp"
#include "moving_mesh/quality.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

namespace {

using namespace mullion::moving_mesh;
namespace files = mullion::mesh_files;

double processor_seconds()
{
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Problem {
  MovingMesh mesh;
  std::vector<double> measures;
  IsGiven is_given;
  Eigen::MatrixXd wall; ///< velocity of the side x_max, elsewhere 0
};

Problem problem(const std::string& text)
{
  const auto file = files::generated(text);
  std::vector<files::Block> cells;
  for (const auto& block : file.blocks)
    if (files::facts(block.shape).dimension == file.dimension) cells.push_back(block);
  Problem p{mesh_of_blocks(file.nodes, cells), {}, {}, Eigen::MatrixXd::Zero(file.dimension, file.nodes.cols())};
  p.measures = element_measures(p.mesh, p.mesh.nodes);
  p.is_given = constraints(p.mesh, {}, {}).is_given;
  for (Eigen::Index i = 0; i < file.nodes.cols(); ++i)
    if (file.nodes(0, i) == 1.0) p.wall(0, i) = std::sin(3.0 * file.nodes(1, i));
  return p;
}

/// Mean of a few calls, a tenth of a second of them at least.
template <class Function> double seconds_of(const Function& function)
{
  const double begin = processor_seconds();
  int n = 0;
  do {
    function();
    ++n;
  } while (processor_seconds() - begin < 0.1);
  return (processor_seconds() - begin) / n;
}

struct Cost {
  double setup, solve, quality;
};

Cost cost(const Problem& p, bool is_elastic)
{
  const double begin = processor_seconds();
  const auto solver =
      is_elastic
          ? coupled_solver(elasticity_matrix(p.mesh, inverse_measure_stiffness(p.measures, 1.0), 0.3), p.is_given)
          : solver_by_component(laplacian_matrix(p.mesh, masud_hughes_stiffness(p.measures)), p.is_given);
  const double setup = processor_seconds() - begin;
  Eigen::MatrixXd u;
  const double solve = seconds_of([&] { complete_motion(solver, u = p.wall); });
  double smallest = 1.0;
  const double quality = seconds_of(
      [&] { smallest = std::min(smallest, quality_of(p.mesh, p.measures, p.mesh.nodes + 1e-4 * u).min_area_ratio); });
  if (!(smallest > 0.0)) fmt::print("the mesh folded\n");
  return {setup, solve, quality};
}

void measure(const std::string& text, bool is_elastic, double& nodes_before, double& step_before)
{
  const auto p = problem(text);
  const auto [setup, solve, quality] = cost(p, is_elastic);
  const auto nodes = static_cast<double>(p.mesh.nodes.cols());
  const double step = solve + quality;
  const double growth = nodes_before > 0.0 ? std::log(step / step_before) / std::log(nodes / nodes_before) : 0.0;
  fmt::print("{:18} {:13} {:8.0f} {:10.1f} {:10.3f} {:10.3f} {:10.3f} {:8.2f}\n", text,
             is_elastic ? "elastic_mesh" : "laplacian", nodes, 1e3 * setup, 1e3 * solve, 1e3 * quality, 1e3 * step,
             growth);
  nodes_before = nodes;
  step_before = step;
}

} // namespace

int main(int argc, char** argv)
{
  double largest = 1e5;
  for (int i = 1; i + 1 < argc; ++i)
    if (std::strcmp(argv[i], "--largest") == 0) largest = std::atof(argv[i + 1]);
  fmt::print("{:18} {:13} {:>8} {:>10} {:>10} {:>10} {:>10} {:>8}\n", "mesh", "equation", "nodes", "setup ms",
             "solve ms", "quality ms", "step ms", "growth");
  for (const bool is_elastic : {false, true}) {
    double nodes = 0.0, step = 0.0;
    for (const int n : {31, 99, 315})
      if ((n + 1.0) * (n + 1.0) <= largest) measure(fmt::format("box:{}x{}", n, n), is_elastic, nodes, step);
    nodes = 0.0;
    for (const int n : {9, 17, 26})
      if (std::pow(n + 1.0, 3) <= largest && !(is_elastic && n > 17))
        measure(fmt::format("box:{}x{}x{}", n, n, n), is_elastic, nodes, step);
  }
  return 0;
}
