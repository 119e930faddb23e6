// HLLC with respect to a moving face.
#include "riemann.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler_1d {

namespace {

struct Speeds {
  double left, right;
};

Speeds outer_speeds(const Gas& gas, const Primitive& l, const Primitive& r)
{
  const double weight_l = std::sqrt(l.density);
  const double weight_r = std::sqrt(r.density);
  const double sum = weight_l + weight_r;
  const double enthalpy_l = (energy_density(gas, l) + l.pressure) / l.density;
  const double enthalpy_r = (energy_density(gas, r) + r.pressure) / r.density;
  const double u = (weight_l * l.velocity + weight_r * r.velocity) / sum;
  const double enthalpy = (weight_l * enthalpy_l + weight_r * enthalpy_r) / sum;
  const double c = std::sqrt((gas.gamma - 1.0) * (enthalpy - 0.5 * u * u));
  return {std::min(l.velocity - sound_speed(gas, l), u - c), std::max(r.velocity + sound_speed(gas, r), u + c)};
}

// Flux of the star state on one side (outer wave s, contact s_star), relative to the face.
Flux star_flux(const Gas& gas, const Primitive& q, double s, double s_star, double w)
{
  const double density = q.density * (s - q.velocity) / (s - s_star);
  const double pressure = q.pressure + q.density * (s - q.velocity) * (s_star - q.velocity);
  const double energy =
      (energy_density(gas, q) * (s - q.velocity) - q.pressure * q.velocity + pressure * s_star) / (s - s_star);
  const double through = s_star - w;
  return {density * through, density * through * s_star + pressure, energy * through + pressure * s_star};
}

} // namespace

Flux hllc_flux(const Gas& gas, const Primitive& left, const Primitive& right, double w)
{
  const auto [s_l, s_r] = outer_speeds(gas, left, right);
  if (w <= s_l) return physical_flux(gas, left, w);
  if (w >= s_r) return physical_flux(gas, right, w);

  const double mass_l = left.density * (s_l - left.velocity);   // < 0
  const double mass_r = right.density * (s_r - right.velocity); // > 0, so the quotient exists
  const double s_star =
      (right.pressure - left.pressure + left.velocity * mass_l - right.velocity * mass_r) / (mass_l - mass_r);
  return w <= s_star ? star_flux(gas, left, s_l, s_star, w) : star_flux(gas, right, s_r, s_star, w);
}

} // namespace mullion::euler_1d
