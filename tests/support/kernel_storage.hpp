// Memory for the piston kernels in tests, where no window owns it.
#pragma once

#include "elastic_bar/newmark.hpp"
#include "euler_1d/ale_step.hpp"

#include <cstddef>
#include <vector>

namespace mullion::testing {

/// A gas column of n cells: state, node velocities and workspace.
struct GasColumn {
  explicit GasColumn(std::size_t n)
      : mass(n), momentum(n), energy(n), length(n), node_x(n + 1), w_begin(n + 1), w_end(n + 1),
        workspace(n)
  {
  }

  euler_1d::State state() { return {mass, momentum, energy, length, node_x}; }

  /// One step whose wall moves with the given velocities, the nodes linearly between.
  euler_1d::WallIntegrals advance(double wall_begin, double wall_end, double dt,
                                  const euler_1d::AleOptions& options = {})
  {
    euler_1d::linear_node_velocities(wall_begin, w_begin);
    euler_1d::linear_node_velocities(wall_end, w_end);
    return euler_1d::advance(state(), w_begin, w_end, dt, options, workspace);
  }

  std::vector<double> mass, momentum, energy, length, node_x, w_begin, w_end;
  euler_1d::Workspace workspace;
};

/// Motion of a bar's nodes, at rest.
struct BarMotion {
  explicit BarMotion(const elastic_bar::Bar& bar)
      : displacement(bar.n_nodes()), velocity(bar.n_nodes()), acceleration(bar.n_nodes())
  {
  }

  elastic_bar::Motion view() { return {displacement, velocity, acceleration}; }

  std::vector<double> displacement, velocity, acceleration;
};

} // namespace mullion::testing
