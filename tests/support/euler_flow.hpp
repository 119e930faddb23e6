// A flow on a generated mesh, from the bare kernels of the euler module: what its unit and verification tests set up.
#pragma once

#include "euler/initial.hpp"
#include "euler/mesh_input.hpp"
#include "euler/solver.hpp"

#include "files/read.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace mullion::testing {

/// A patch of the generated mesh and what holds there.
template <int D> struct Side {
  std::string group;
  euler::Condition<D> condition;
};

template <int D> euler::Condition<D> wall() { return {}; }
template <int D> euler::Condition<D> far_field(const euler::Values<D>& state)
{
  euler::Condition<D> condition;
  condition.kind = euler::Kind::far_field;
  condition.state = state;
  return condition;
}

/// Mesh, solver, nodes and amounts of a flow, and steps that must succeed.
template <int D> class EulerFlow {
public:
  using Nodes = Eigen::Matrix<double, D, Eigen::Dynamic>;

  EulerFlow(const mesh_files::MeshFile& file, const std::vector<Side<D>>& sides, const euler::Scheme<D>& scheme,
            const std::vector<std::pair<std::string, std::string>>& periodic = {}, int n_threads = 1)
      : source(make_source(file, sides, periodic)),
        solver(euler::build_mesh(source), conditions_of(sides, periodic), scheme, n_threads), nodes(source.nodes)
  {
    REQUIRE(solver.place(nodes).kind == euler::Outcome<D>::Kind::fine);
  }
  EulerFlow(const std::string& text, const std::vector<Side<D>>& sides, const euler::Scheme<D>& scheme,
            const std::vector<std::pair<std::string, std::string>>& periodic = {}, int n_threads = 1)
      : EulerFlow(mesh_files::read_or_generate(text, D), sides, scheme, periodic, n_threads)
  {
  }

  void start(const euler::StateFunction<D>& state, euler::Average average = euler::Average::centroid)
  {
    euler::set_amounts(source, solver.mesh(), solver.scheme().gas, solver.geometry().volume, solver.geometry().centroid,
                       state, average, amounts);
  }

  /// On the resting mesh.
  void step(double dt)
  {
    const auto outcome = solver.advance(amounts, time, dt, nodes, courant_limit);
    REQUIRE(outcome.kind == euler::Outcome<D>::Kind::fine);
    time += dt;
  }
  /// While the nodes move with v.
  void step(double dt, const Nodes& v)
  {
    const auto outcome = solver.advance_moving(amounts, time, dt, nodes, v, courant_limit);
    REQUIRE(outcome.kind == euler::Outcome<D>::Kind::fine);
    nodes += dt * v;
    time += dt;
  }
  /// Nodes follow a path x(X, t); v dt is exactly the way from one time to the next.
  void follow(double dt, const std::function<euler::Vec<D>(const euler::Vec<D>&, double)>& path)
  {
    Nodes v(D, nodes.cols());
    for (Eigen::Index i = 0; i < nodes.cols(); ++i)
      v.col(i) = (path(source.nodes.col(i), time + dt) - nodes.col(i)) / dt;
    step(dt, v);
  }

  /// Largest step for this Courant number now, the mesh at rest.
  double stable_step(double courant) { return courant * solver.unit_step(amounts); }

  euler::Values<D> value(std::size_t cell) const
  {
    return euler::primitive<D>(solver.scheme().gas, amounts[cell],
                               euler::cell_shape(solver.mesh(), nodes, cell).volume);
  }
  euler::CellShape<D> shape(std::size_t cell) const { return euler::cell_shape(solver.mesh(), nodes, cell); }
  euler::Values<D> totals() const
  {
    euler::Values<D> sum{};
    for (const auto& a : amounts)
      for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += a[v];
    return sum;
  }

  euler::MeshSource<D> source;
  euler::Solver<D> solver;
  Nodes nodes;
  std::vector<euler::Values<D>> amounts;
  double time = 0.0;
  double courant_limit = std::numeric_limits<double>::infinity();

private:
  static euler::MeshSource<D> make_source(const mesh_files::MeshFile& file, const std::vector<Side<D>>& sides,
                                          const std::vector<std::pair<std::string, std::string>>& periodic)
  {
    std::vector<std::string> names;
    for (const auto& side : sides) names.push_back(side.group);
    for (const auto& [first, second] : periodic) {
      names.push_back(first);
      names.push_back(second);
    }
    auto source = euler::source_of<D>(file, names);
    for (std::size_t k = 0; k < periodic.size(); ++k)
      source.periodic.push_back({static_cast<int>(sides.size() + 2 * k), static_cast<int>(sides.size() + 2 * k + 1)});
    return source;
  }
  static std::vector<euler::Condition<D>>
  conditions_of(const std::vector<Side<D>>& sides, const std::vector<std::pair<std::string, std::string>>& periodic)
  {
    std::vector<euler::Condition<D>> conditions;
    for (const auto& side : sides) conditions.push_back(side.condition);
    conditions.resize(conditions.size() + 2 * periodic.size());
    return conditions;
  }
};

/// Largest deviation from a uniform state, each variable relative to its size (velocities to the speed).
template <int D> double deviation(const EulerFlow<D>& flow, const euler::Values<D>& state)
{
  const double speed = std::sqrt(euler::square_of_velocity<D>(state));
  double worst = 0.0;
  for (std::size_t c = 0; c < flow.amounts.size(); ++c) {
    const auto w = flow.value(c);
    for (std::size_t v = 0; v < w.size(); ++v) {
      const double scale = v == 0 || v + 1 == w.size() ? state[v] : speed;
      const double d = std::abs(w[v] - state[v]) / scale;
      worst = d <= worst ? worst : d; // keeps what is no number
    }
  }
  return worst;
}

} // namespace mullion::testing
