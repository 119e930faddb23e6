// What a stage of the euler module costs, next to what the memory allows: cells per second through one stage of
// Runge-Kutta, first order, and second order with a limiter; resting and moving mesh; one thread and two. The bound is
// a triad a = b + s c over large arrays in the same run. Rounds are interleaved; medians.
//
// Bytes are counted pass by pass: each pass over the mesh must read what it uses and write what it makes once, the rest
// comes from caches (neighbours lie close together). Passes that come once a step count for a quarter of a stage.
// Written arrays count once, as in the triad's 24 bytes. Not counted, because it never leaves the caches: the
// residuals, of the cells that a face still reaches.
//
//   build-dev/bench/euler_sweep [--cells N] [--rounds R]
#include "euler/initial.hpp"
#include "euler/mesh_input.hpp"
#include "euler/solver.hpp"

#include "files/read.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

namespace {

using namespace mullion::euler;
using Clock = std::chrono::steady_clock;

double seconds(const std::function<void()>& f)
{
  const auto begin = Clock::now();
  f();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values)
{
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Bytes per second of a triad, each thread on its own part.
class Triad {
public:
  explicit Triad(std::size_t n) : a_(n, 1.0), b_(n, 2.0), c_(n, 3.0) {}
  double bandwidth(Crew& crew)
  {
    const auto n = a_.size(), parts = static_cast<std::size_t>(crew.size());
    const double s = seconds([&] {
      crew.run([&](int p) {
        const auto part = static_cast<std::size_t>(p);
        for (std::size_t i = n * part / parts; i < n * (part + 1) / parts; ++i) a_[i] = b_[i] + 0.5 * c_[i];
      });
    });
    return 24.0 * static_cast<double>(n) / s;
  }

private:
  std::vector<double> a_, b_, c_;
};

struct Case {
  const char* name;
  const char* cells;
  int order;
  bool is_moving;
  double bytes; ///< that a stage has to move for a cell, each array once
};

// Quadrilaterals, two faces a cell.
// Each stage, fluxes and update: values read and written 64, amounts 32 and in the last stage written 8, volume 8,
// planes 64, owners and neighbours 16. Once a step: amounts to values 72; Courant numbers from values, volume, planes,
// faces of the cell 124.
constexpr double first = 192.0 + (72.0 + 124.0) / 4.0;
// Each stage, gradients: values 32, gradients written 64, stencil 20, weights 64, offsets 64, faces of the cell 20,
// volume 8; fluxes: gradients 64, offsets 64.
constexpr double second = first + 272.0 + 128.0;
// Each stage: planes written 64, nodes of the faces 16, positions and velocities 32. Once a step: volumes and centroids
// 76; second order: offsets and weights 204.
constexpr double moving = 112.0 + 76.0 / 4.0, moving_second = moving + 204.0 / 4.0;
constexpr Case cases[] = {{"first order", "quads", 1, false, first},
                          {"second order, limiter", "quads", 2, false, second},
                          {"first order, moving", "quads", 1, true, first + moving},
                          {"second order, limiter, moving", "quads", 2, true, second + moving_second}};

struct Flow {
  std::unique_ptr<Solver<2>> solver;
  std::vector<Values<2>> amounts;
  Eigen::Matrix2Xd nodes, velocity;
  double dt = 0.0;
  bool is_moving = false;

  Flow(const Case& c, int n, int threads) : is_moving(c.is_moving)
  {
    const auto file = mullion::mesh_files::read_or_generate(fmt::format("box:{0}x{0},{1}", n, c.cells), 2);
    const auto source = source_of<2>(file, {"x_min", "x_max", "y_min", "y_max"});
    Scheme<2> scheme;
    scheme.order = c.order;
    scheme.limiter = {c.order == 2 ? Limiter::venkatakrishnan : Limiter::none, 5.0, 1.0, {1.0, 1.0, 1.0, 1.0}};
    solver = std::make_unique<Solver<2>>(build_mesh(source), std::vector<Condition<2>>(4), scheme, threads);
    nodes = source.nodes;
    velocity = Eigen::Matrix2Xd::Zero(2, nodes.cols());
    require(solver->place(nodes));
    const auto& geometry = solver->geometry();
    set_amounts<2>(
        source, solver->mesh(), scheme.gas, geometry.volume, geometry.centroid,
        [](const Vec<2>& x) {
          return Values<2>{1.0 + 0.1 * std::sin(6.0 * x.x()), 0.1 * std::sin(5.0 * x.y()), 0.0, 1.0};
        },
        Average::centroid, amounts);
    dt = 0.5 * solver->unit_step(amounts);
  }
  static void require(const Outcome<2>& outcome)
  {
    if (outcome.kind == Outcome<2>::Kind::fine) return;
    std::fputs("the flow broke down\n", stderr);
    std::exit(1);
  }
  void step()
  {
    require(is_moving ? solver->advance_moving(amounts, 0.0, dt, nodes, velocity, 10.0)
                      : solver->advance(amounts, 0.0, dt, nodes, 10.0));
  }
};

} // namespace

int main(int argc, char** argv)
{
  int cells = 250'000, rounds = 7;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--cells") == 0) cells = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--rounds") == 0) rounds = std::atoi(argv[i + 1]);
  }
  const int n = static_cast<int>(std::lround(std::sqrt(cells)));
  const double n_cells = static_cast<double>(n) * n;
  constexpr int n_steps = 3;
  Triad triad(8'000'000);
  fmt::print("{} x {} cells; bytes a cell and stage as counted in this file\n", n, n);
  fmt::print("{:<32}{:>8}{:>12}{:>12}{:>12}{:>10}{:>14}\n", "", "threads", "ns/cell", "Mcells/s", "GB/s", "of triad",
             "bytes/cell");
  for (const auto& c : cases) {
    double alone = 0.0;
    for (const int threads : {1, 2}) {
      Flow flow(c, n, threads);
      Crew crew(threads);
      flow.step(); // touches the memory
      std::vector<double> stage, bandwidth;
      for (int r = 0; r < rounds; ++r) {
        stage.push_back(seconds([&] {
                          for (int s = 0; s < n_steps; ++s) flow.step();
                        }) /
                        (4.0 * n_steps));
        bandwidth.push_back(triad.bandwidth(crew));
      }
      const double s = median(stage), roof = median(bandwidth), moved = c.bytes * n_cells / s;
      fmt::print("{:<32}{:>8}{:>12.1f}{:>12.2f}{:>12.2f}{:>9.0f}%{:>14.0f}", c.name, threads, 1e9 * s / n_cells,
                 1e-6 * n_cells / s, 1e-9 * moved, 100.0 * moved / roof,
                 static_cast<double>(flow.solver->memory()) / n_cells);
      if (threads == 1) alone = s;
      else fmt::print("   {:+.0f} % with the second thread", 100.0 * (alone / s - 1.0));
      fmt::print("\n");
      std::fflush(stdout);
    }
  }
  return 0;
}
