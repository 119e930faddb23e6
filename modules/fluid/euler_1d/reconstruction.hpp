// Values at the faces from cell means: MUSCL on (rho, u, p), linear in each cell.
#pragma once

#include "gas.hpp"

#include <span>

namespace mullion::euler_1d {

/// How the slope of an inner cell comes from the two one-sided ones.
enum class Limiter {
  none,       ///< their average (Fromm): second order, for smooth flow
  van_albada, ///< a b (a + b) / (a^2 + b^2), zero where they differ in sign: for shocks (van Albada
              ///< et al. 1982)
};

/// Linear reconstruction of all cells.
///
///     q_i(x) = q_i + s_i (x - x_i),  one-sided slopes (q_{i+1} - q_i) / ((L_i + L_{i+1}) / 2)
///
/// The first and the last cell take their only one-sided slope, unlimited: second order up to the
/// wall, but a strong shock that arrives there may overshoot. A single cell has slope zero. Linear
/// data are exact on any mesh.
///
/// @param cells        n_cells cell means
/// @param length       n_cells, L [m]
/// @param left_value   n_cells: value of each cell at its own left face
/// @param right_value  n_cells: value of each cell at its own right face
void reconstruct(std::span<const Primitive> cells, std::span<const double> length, Limiter limiter,
                 std::span<Primitive> left_value, std::span<Primitive> right_value);

/// Value at the outer face of an end cell from it and its neighbour: q_e + (q_e - q_n) L_e / (L_e +
/// L_n), on equal cells 1.5 q_e - 0.5 q_n. The same bits as reconstruct() gives there.
[[nodiscard]] Primitive end_value(const Primitive& end_cell, double end_length, const Primitive& neighbour,
                                  double neighbour_length);

} // namespace mullion::euler_1d
