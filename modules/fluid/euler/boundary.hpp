// Boundary conditions: what meets the gas at a face on the boundary, or the flux through it.
#pragma once

#include "gas.hpp"

#include <algorithm>
#include <functional>

namespace mullion::euler {

enum class Kind {
  wall,              ///< impermeable, without friction; moves as its nodes do
  far_field,         ///< the flux between the gas and the free stream
  prescribed,        ///< the same with a state that depends on place and time
  subsonic_inflow,   ///< total pressure and temperature
  subsonic_outflow,  ///< static pressure
  supersonic_inflow, ///< the free stream
  supersonic_outflow ///< what comes
};

/// What holds on one patch.
template <int D> struct Condition {
  Kind kind = Kind::wall;
  Values<D> state{};                                            ///< (rho, u, p) of far_field, supersonic_inflow
  double total_pressure = 0.0;                                  ///< subsonic_inflow [Pa]
  double total_sound_speed = 0.0;                               ///< subsonic_inflow: that of the gas at rest [m/s]
  double pressure = 0.0;                                        ///< subsonic_outflow [Pa]
  std::function<Values<D>(const Vec<D>& x, double t)> function; ///< prescribed
};

/// Does the boundary's state meet the gas through the numerical flux, as a neighbour's would?
inline bool is_upwinded(Kind kind) { return kind == Kind::far_field || kind == Kind::prescribed; }

/// Pressure on a wall, of the exact Riemann problem between the gas and its mirror image.
///
///     d <= 0, receding:   p_w = p (1 + (gamma - 1) / 2 d / c)^(2 gamma / (gamma - 1))
///     d > 0, compressing: p_w = p + d (B + sqrt(B^2 + gamma p rho)),  B = (gamma + 1) / 4 rho d
///
/// toro2009 section 6.3.3.
/// @param w  (rho, u, p) at the wall
/// @param d  u . n - s: of the gas towards the wall, n out of the gas [m/s]
template <int D> inline double wall_pressure(const Gas& gas, const Values<D>& w, double d)
{
  const double rho = w[0], p = w[D + 1], g = gas.gamma;
  if (d <= 0.0) {
    const double base = 1.0 + 0.5 * (g - 1.0) * d / sound_speed<D>(gas, w);
    return p * std::pow(std::max(base, 1e-6), 2.0 * g / (g - 1.0)); // below that: a vacuum opens at the wall
  }
  const double b = 0.25 * (g + 1.0) * rho * d;
  return p + d * (b + std::sqrt(b * b + g * p * rho));
}

/// Flux per area through a face of a condition that is not upwinded; for a wall also the pressure on it.
///
/// Inflow with total state: the characteristic that leaves, R = u_n + 2 c / (gamma - 1) with u_n out of the gas, and
/// the total sound speed give c; the flow comes in along the normal. Outflow with a static pressure: entropy and R of
/// the gas.
///
/// @param w  (rho, u, p) of the gas at the face;  n  unit normal out of the gas;  s  of the face along it [m/s]
template <int D>
inline Values<D> boundary_flux(const Gas& gas, const Condition<D>& condition, const Values<D>& w, const double* n,
                               double s)
{
  const double g = gas.gamma, u_n = along<D>(w, n);
  switch (condition.kind) {
  case Kind::wall: {
    const double p_w = wall_pressure<D>(gas, w, u_n - s);
    Values<D> flux{};
    for (int d = 0; d < D; ++d) flux[d + 1] = p_w * n[d];
    flux[D + 1] = p_w * s;
    return flux;
  }
  case Kind::subsonic_inflow: {
    const double c_0 = condition.total_sound_speed;
    const double r = u_n + 2.0 * sound_speed<D>(gas, w) / (g - 1.0);
    // c_0^2 = c^2 + (gamma - 1) / 2 u_n^2 with u_n = r - 2 c / (gamma - 1)
    const double a = 1.0 + 2.0 / (g - 1.0);
    const double root = std::max(r * r - a * (0.5 * (g - 1.0) * r * r - c_0 * c_0), 0.0);
    const double c = (r + std::sqrt(root)) / a;
    Values<D> in;
    const double speed = r - 2.0 * c / (g - 1.0); // along n: negative where gas comes in
    in[D + 1] = condition.total_pressure * std::pow(c / c_0, 2.0 * g / (g - 1.0));
    in[0] = g * in[D + 1] / (c * c);
    for (int d = 0; d < D; ++d) in[d + 1] = speed * n[d];
    return physical_flux<D>(gas, in, n, s);
  }
  case Kind::subsonic_outflow: {
    Values<D> out = w;
    out[D + 1] = condition.pressure;
    out[0] = w[0] * std::pow(condition.pressure / w[D + 1], 1.0 / g);
    const double more = 2.0 * (sound_speed<D>(gas, w) - sound_speed<D>(gas, out)) / (g - 1.0);
    for (int d = 0; d < D; ++d) out[d + 1] += more * n[d];
    return physical_flux<D>(gas, out, n, s);
  }
  case Kind::supersonic_inflow: return physical_flux<D>(gas, condition.state, n, s);
  case Kind::supersonic_outflow: return physical_flux<D>(gas, w, n, s);
  case Kind::far_field:
  case Kind::prescribed: break;
  }
  return {}; // those two are a neighbour's state, see is_upwinded()
}

} // namespace mullion::euler
