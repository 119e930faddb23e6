// Initial states of the bar: at rest, and the bar's part of a mode of the coupled piston.
#pragma once

#include "bar_elements.hpp"
#include "newmark.hpp"

namespace mullion::elastic_bar {

/// Undeformed and at rest; the acceleration is that of the load, a_0 = F / m_0 at node 0.
///
/// @param load  F = A (P_s - p_ref) on node 0 [N]
void set_rest(const Bar& bar, const Motion& motion, double load);

/// A standing wave of the bar whose loaded end has displacement `amplitude`, at its turning point
/// (v = 0).
///
///     clamped:  u(X) = A sin(omega (L_s - X) / c_s) / sin(omega L_s / c_s),   c_s = sqrt(E_s /
///     rho_s) free:     u(X) = A cos(omega (L_s - X) / c_s) / cos(omega L_s / c_s)
///
/// The exact mode of the continuous bar at the nodes; acceleration from equilibrium with the load.
///
/// @param amplitude          A [m]
/// @param angular_frequency  omega; for a coupled start an eigenvalue of the coupled problem
/// [rad/s]
/// @param load               F = A (P_s - p_ref) on node 0 at that instant [N]
/// @pre  the denominator is not zero, i.e. the loaded end is no node of the standing wave
void set_mode(const Bar& bar, const Motion& motion, double amplitude, double angular_frequency, double load);

} // namespace mullion::elastic_bar
