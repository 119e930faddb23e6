// Initial states of the 1D fluid: uniform (at rest, as a rule) and an acoustic mode of the closed
// piston.
#pragma once

#include "gas.hpp"
#include "left_end.hpp"
#include "state.hpp"

namespace mullion::euler_1d {

/// Equal cells between two end points; writes nodes and lengths only.
void set_equal_cells(const State& state, double x_left, double x_right);

/// Uniform values on the mesh that is there.
void set_uniform(const State& state, const Gas& gas, const Primitive& value);

/// Gas at rest in the reference state on equal cells over [0, length].
void set_rest(const State& state, const Gas& gas, const Reference& reference, double length);

/// One acoustic mode of a tube [0, length] closed at x = 0, whose right end moves as A cos(omega
/// t).
struct AcousticMode {
  double amplitude;         ///< A, displacement of the right end at t = 0 [m]
  double angular_frequency; ///< omega; for a coupled start an eigenvalue of the coupled problem
                            ///< [rad/s]
  double length;            ///< undisturbed length L_f [m]
};

/// Cell means of the mode at a given time, on equal cells over [0, wall_x].
///
///     p'(x, t) = -z omega A cos(k x) / sin(k L_f) cos(omega t),   z = rho_0 c,  k = omega / c
///     u (x, t) = -omega A sin(k x) / sin(k L_f) sin(omega t),     mean over a cell: times sin(k
///     dx/2) / (k dx/2)
///
/// from the displacement A sin(k x) / sin(k L_f) cos(omega t) of linear acoustics; the density
/// follows isentropically, rho = rho_0 (p / p_0)^(1/gamma). Half-step-offset schemes start at time
/// = -dt/2.
///
/// @param time    instant of the fluid values [s]
/// @param wall_x  right end of the mesh [m]; collocated L_f + A, independent of `time` as the mesh
/// may live at another
/// @pre           wall_x > 0, sin(k L_f) != 0, and omega A much smaller than c (linear theory)
void set_acoustic_mode(const State& state, const Gas& gas, const Reference& reference, const AcousticMode& mode,
                       double time, double wall_x);

} // namespace mullion::euler_1d
