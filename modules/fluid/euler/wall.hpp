// The wall as a structure sees it: pressure, its gradient and the rest on the faces of some patches, of a given state.
#pragma once

#include "geometry.hpp"
#include "solver.hpp"

#include <vector>

namespace mullion::euler {

/// One face of the wall at one instant.
template <int D> struct WallFace {
  double pressure = 0.0;        ///< absolute, of the wall's Riemann problem [Pa]
  double gradient = 0.0;        ///< dp/dn, n out of the gas, second order [Pa/m]
  double cell_gradient = 0.0;   ///< the same, of the cell alone [Pa/m]
  double sound_speed = 0.0;     ///< of the gas at the wall [m/s]
  double distance = 0.0;        ///< d_n from the wall to the cell's centroid, along n [m]
  Vec<D> area = Vec<D>::Zero(); ///< N, out of the gas [m^2; m in the plane]
};

/// Values at the boundary faces `faces` (numbers of boundary faces): one reconstruction there, no step.
///
///     dp/dn = (p_w - p_c - g d^2 / (2 e)) / (d - d^2 / (2 e)),   d = d_n
///
/// with the pressure p_c and the gradient's normal part g of the cell, which does not use the wall. g holds not at the
/// centroid but at the distance e from the wall, because the stencil lies on the inner side: e = d - 1/2 sum_j (c_j .
/// n) (d_j . n)^2 with the weights c_j and ways d_j of the stencil. On equal cells along the normal that is the
/// parabola through p_w and the two nearest centroids, dp/dn = (4/3) (p_w - p_c) / d - g / 3.
///
/// @param amounts  in the mesh's own order
/// @param x        where the nodes are;  v  velocity of the nodes that goes with the pressure: the wall moves with its
///                 mean over each face
template <int D>
std::vector<WallFace<D>> wall_faces(const Mesh<D>& mesh, const Scheme<D>& scheme, const std::vector<Values<D>>& amounts,
                                    const Nodes<D>& x, const Nodes<D>& v, const std::vector<Index>& faces);

} // namespace mullion::euler
