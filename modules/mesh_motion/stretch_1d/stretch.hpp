// The kernel of the 1D mesh motion: the mesh stretches between a fixed end and the moving wall.
#pragma once

#include <cstddef>
#include <span>

namespace mullion::stretch_1d {

/// Relative position of each node between the fixed end and the wall, xi_i = (X_i - X_0) / (X_wall - X_0).
///
/// @param reference  n_nodes reference coordinates [m]
/// @param fixed_node, wall_node  numbers of the two end nodes; their coordinates must differ
/// @param xi         n_nodes, out: 0 at the fixed end, 1 at the wall [1]
inline void relative_positions(std::span<const double> reference, std::size_t fixed_node, std::size_t wall_node,
                               std::span<double> xi)
{
  const double origin = reference[fixed_node], span = reference[wall_node] - origin;
  for (std::size_t i = 0; i < xi.size(); ++i) xi[i] = (reference[i] - origin) / span;
}

/// w_i = xi_i w: every cell keeps its share of the length.
///
/// @param wall_velocity  w [m/s]
/// @param velocity       n_nodes, out [m/s]
inline void stretch(std::span<const double> xi, double wall_velocity, std::span<double> velocity)
{
  for (std::size_t i = 0; i < xi.size(); ++i) velocity[i] = xi[i] * wall_velocity;
}

} // namespace mullion::stretch_1d
