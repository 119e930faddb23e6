// The calorically perfect gas of the 1D Euler solver: its point values and the algebra between
// them. No cells, no faces, no time.
#pragma once

#include <cmath>

namespace mullion::euler_1d {

/// A calorically perfect gas, p = (gamma - 1) rho e.
struct Gas {
  double gamma = 1.4; ///< ratio of specific heats [1]
};

/// Point or cell-mean values (rho, u, p).
struct Primitive {
  double density = 0.0;  ///< rho [kg/m^3]
  double velocity = 0.0; ///< u, along +x, laboratory frame [m/s]
  double pressure = 0.0; ///< p, absolute [Pa]
};

/// What crosses a face along +x, per unit area and time.
struct Flux {
  double mass = 0.0;     ///< [kg/(m^2 s)]
  double momentum = 0.0; ///< [Pa]
  double energy = 0.0;   ///< [W/m^2]
};

/// c = sqrt(gamma p / rho) [m/s]; not-a-number where p / rho < 0, which find_bad_cell() reports.
inline double sound_speed(const Gas& gas, const Primitive& q) { return std::sqrt(gas.gamma * q.pressure / q.density); }

/// z = rho c = sqrt(gamma p rho) [Pa s/m].
inline double impedance(const Gas& gas, const Primitive& q) { return std::sqrt(gas.gamma * q.pressure * q.density); }

/// rho E = p / (gamma - 1) + rho u^2 / 2 [J/m^3].
inline double energy_density(const Gas& gas, const Primitive& q)
{
  return q.pressure / (gas.gamma - 1.0) + 0.5 * q.density * q.velocity * q.velocity;
}

/// Flux of a single state through a face that moves with w: F(U) - w U.
inline Flux physical_flux(const Gas& gas, const Primitive& q, double w)
{
  const double through = q.velocity - w;
  const double mass = q.density * through;
  return {mass, mass * q.velocity + q.pressure, energy_density(gas, q) * through + q.pressure * q.velocity};
}

} // namespace mullion::euler_1d
