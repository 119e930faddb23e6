// Wall values of a given state.
#include "wall.hpp"

#include "reconstruction.hpp"

namespace mullion::euler_1d {

WallState wall_state(const ConstState& state, const Gas& gas, double w)
{
  const std::size_t last = state.n_cells() - 1;
  const Primitive near = cell_primitive(state, gas, last);
  const Primitive next = cell_primitive(state, gas, last - 1);
  const double near_length = state.length[last];
  const double next_length = state.length[last - 1];
  const Primitive face = end_value(near, near_length, next, next_length);
  const double p_w = wall_pressure(gas, face, w);

  // Parabola through p_w at 0, p_N at -a, p_{N-1} at -b.
  const double a = 0.5 * near_length;
  const double b = near_length + 0.5 * next_length;
  const double gradient =
      p_w * (1.0 / a + 1.0 / b) - near.pressure * (b / (a * (b - a))) + next.pressure * (a / (b * (b - a)));
  return {p_w, gradient, face.density, sound_speed(gas, face), near_length};
}

} // namespace mullion::euler_1d
