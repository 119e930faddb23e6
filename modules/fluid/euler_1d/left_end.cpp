// Closed and open left ends.
#include "left_end.hpp"

namespace mullion::euler_1d {

Primitive open_end_state(const Gas& gas, const Reference& outside, const Primitive& q, double w)
{
  const double z = impedance(gas, q);
  const double p_b = 0.5 * (q.pressure + outside.pressure) - 0.5 * z * q.velocity;
  const double u_b = 0.5 * q.velocity - 0.5 * (q.pressure - outside.pressure) / z;
  const double rho_b =
      u_b > w ? outside.density + (p_b - outside.pressure) * outside.density / (gas.gamma * outside.pressure)
              : q.density + (p_b - q.pressure) * q.density / (gas.gamma * q.pressure);
  return {rho_b, u_b, p_b};
}

Flux left_end_flux(const Gas& gas, LeftEnd kind, const Reference& outside, const Primitive& q, double w)
{
  if (kind == LeftEnd::open) return physical_flux(gas, open_end_state(gas, outside, q, w), w);
  const double p_w = q.pressure - impedance(gas, q) * (q.velocity - w);
  return {0.0, p_w, p_w * w};
}

} // namespace mullion::euler_1d
