// What the solid costs: stiffness and mass of one element, assembly, factorisation, a solution and a whole step of
// Newmark's method, by the number of elements; the lowest modes.
//
//   build-dev/bench/elastic_solid [--benchmark_filter=assembly]
#include "elastic_solid/modes.hpp"
#include "elastic_solid/time_integration.hpp"
#include "support/solid_meshes.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace mullion::elastic_solid;
using namespace mullion::testing;

/// A square of n x n enhanced quadrilaterals, clamped on the left.
Solid square(int n)
{
  auto solid = mapped(n, n, [](double s, double t) { return Eigen::Vector2d(s, t + 0.1 * s * t); });
  solid.material = {.youngs_modulus = 70.0e9, .poisson_ratio = 0.3, .density = 2600.0};
  solid.formulation = Formulation::enhanced;
  return solid;
}

System system_of(int n)
{
  const auto solid = square(n);
  return {.stiffness = stiffness_matrix(solid),
          .mass = mass_matrix(solid, MassKind::consistent),
          .free = free_dofs(solid, [n](auto node, auto) { return node % (n + 1) == 0; })};
}

void element(benchmark::State& state)
{
  const auto shape = state.range(0) == 2 ? Shape::quadrilateral4 : Shape::hexahedron8;
  const auto formulation = state.range(1) == 0 ? Formulation::standard : Formulation::enhanced;
  Eigen::MatrixXd nodes = reference_nodes(shape);
  nodes(0, 1) += 0.2;
  const auto c = elasticity({1.0, 0.3, 1.0, Plane::stress}, static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(element_stiffness(shape, formulation, nodes, c));
}

void assembly(benchmark::State& state)
{
  const auto solid = square(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(stiffness_matrix(solid));
  state.SetItemsProcessed(state.iterations() * n_elements(solid));
}

void factorisation(benchmark::State& state)
{
  const auto system = system_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(FreeSolver(system.stiffness, system.free).is_positive());
}

void solution(benchmark::State& state)
{
  const auto system = system_of(static_cast<int>(state.range(0)));
  const FreeSolver solver(system.stiffness, system.free);
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(system.stiffness.rows());
  for (auto _ : state) benchmark::DoNotOptimize(solver.solve(load));
}

void newmark_step(benchmark::State& state)
{
  const auto system = system_of(static_cast<int>(state.range(0)));
  const auto n = system.stiffness.rows();
  const Eigen::VectorXd load = Eigen::VectorXd::Ones(n), zero = Eigen::VectorXd::Zero(n);
  Eigen::VectorXd u = zero, v = zero, a = zero;
  const Newmark newmark(system, {}, 1e-5);
  for (auto _ : state) newmark.step(system, {u, v, a}, load, load, {zero, zero, zero});
}

void ten_modes(benchmark::State& state)
{
  const auto system = system_of(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(lowest_modes(system, 10).angular_frequencies);
}

} // namespace

BENCHMARK(element)->ArgNames({"dimension", "enhanced"})->ArgsProduct({{2, 3}, {0, 1}})->Unit(benchmark::kMicrosecond);
BENCHMARK(assembly)->ArgName("n")->RangeMultiplier(4)->Range(8, 128)->Unit(benchmark::kMillisecond);
BENCHMARK(factorisation)->ArgName("n")->RangeMultiplier(4)->Range(8, 128)->Unit(benchmark::kMillisecond);
BENCHMARK(solution)->ArgName("n")->RangeMultiplier(4)->Range(8, 128)->Unit(benchmark::kMillisecond);
BENCHMARK(newmark_step)->ArgName("n")->RangeMultiplier(4)->Range(8, 128)->Unit(benchmark::kMillisecond);
BENCHMARK(ten_modes)->ArgName("n")->RangeMultiplier(4)->Range(8, 128)->Unit(benchmark::kMillisecond);
BENCHMARK_MAIN();
