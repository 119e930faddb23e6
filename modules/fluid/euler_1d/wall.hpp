// The moving wall at the right end, where the structure sits: its pressure as the Riemann problem
// gives it, and what the coupling schemes read there.
#pragma once

#include "gas.hpp"
#include "state.hpp"

namespace mullion::euler_1d {

/// Pressure on a wall whose fluid lies on the left, by the linearised Riemann problem.
///
///     p_w = p + sqrt(gamma p rho) (u - w)
///
/// The characteristic dp + z du = 0 from the fluid to the wall; the error is of the order of ((u -
/// w) / c)^2 p. The pressure acts along the outward fluid normal n_f = +1, compression positive.
///
/// @param q  fluid state at the face
/// @param w  velocity of the wall along +x [m/s], positive: the fluid expands
inline double wall_pressure(const Gas& gas, const Primitive& q, double w)
{
  return q.pressure + impedance(gas, q) * (q.velocity - w);
}

/// Flux through the wall: no mass, the pressure, and the power p_w w that the fluid delivers.
inline Flux wall_flux(double p_w, double w) { return {0.0, p_w, p_w * w}; }

/// What the interface sees of the fluid at one instant.
struct WallState {
  double pressure;          ///< p_w, absolute, along n_f = +1 [Pa]
  double pressure_gradient; ///< dp/dx at the wall, along n_f = +1 [Pa/m]
  double density;           ///< face value [kg/m^3]
  double sound_speed;       ///< from the face values of p and rho [m/s]
  double spacing;           ///< length of the last cell [m]
};

/// Wall values of a state, for the wall velocity that belongs to the same time.
///
/// The face value is the extrapolation 1.5 q_N - 0.5 q_{N-1} (equal cells). The gradient is that of
/// the parabola through the wall pressure and the two nearest cell centres ("grad 2"), on equal
/// cells
///
///     dp/dx = (8/3 p_w - 3 p_N + 1/3 p_{N-1}) / dx
///
/// The parabola is second order in its data, but the extrapolation error of p_w is divided by dx:
/// with cell means the gradient is too low by dx (p_xx + 8/9 z u_xx), first order. (p_N - p_{N-1})
/// / dx does not know the wall's motion.
///
/// @param w  wall velocity at the time of the state [m/s]. A velocity from the middle of the step
/// costs the wall
///           pressure one order in time.
/// @pre      at least two cells
[[nodiscard]] WallState wall_state(const ConstState& state, const Gas& gas, double w);

} // namespace mullion::euler_1d
