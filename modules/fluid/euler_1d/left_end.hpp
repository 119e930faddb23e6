// The left end of the fluid: a rigid wall ("closed") or a boundary that lets waves leave ("open").
#pragma once

#include "gas.hpp"

namespace mullion::euler_1d {

enum class LeftEnd {
  closed, ///< wall that moves with its node (at rest as a rule)
  open,   ///< non-reflecting: the gas outside is at rest in the reference state
};

/// Gas at rest outside an open end.
struct Reference {
  double density = 1.3;    ///< rho_0 [kg/m^3]
  double pressure = 1.0e5; ///< p_0 [Pa]
};

/// State on an open left end, from the characteristics.
///
///     leaving:   p_b - z u_b = p - z u,   z = sqrt(gamma p rho) of the inner state
///     arriving:  p_b + z u_b = p_0
///     =>  p_b = (p + p_0) / 2 - z u / 2,  u_b = u / 2 - (p - p_0) / (2 z)
///     entropy:   rho_b = rho + (p_b - p) / c^2 on outflow,  rho_0 + (p_b - p_0) / c_0^2 on inflow
///
/// Linearised about the local state, so a wave of relative strength eps reflects with O(eps^2).
///
/// @param q  fluid state at the face
/// @param w  velocity of the face [m/s]; it decides between inflow and outflow
[[nodiscard]] Primitive open_end_state(const Gas& gas, const Reference& outside, const Primitive& q, double w);

/// Flux through the left face, along +x, relative to the face that moves with w.
///
/// Closed: (0, p_w, p_w w) with p_w = p - sqrt(gamma p rho) (u - w). Open: F(U_b) - w U_b.
[[nodiscard]] Flux left_end_flux(const Gas& gas, LeftEnd kind, const Reference& outside, const Primitive& q, double w);

} // namespace mullion::euler_1d
