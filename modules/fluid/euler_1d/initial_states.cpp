// Uniform states and acoustic modes.
#include "initial_states.hpp"

#include <cmath>

namespace mullion::euler_1d {

void set_equal_cells(const State& state, double x_left, double x_right)
{
  const std::size_t n = state.n_cells();
  const double width = x_right - x_left;
  for (std::size_t i = 0; i < n; ++i) {
    state.node_x[i] = x_left + width * (static_cast<double>(i) / static_cast<double>(n));
    state.length[i] = width / static_cast<double>(n);
  }
  state.node_x[n] = x_right;
}

void set_uniform(const State& state, const Gas& gas, const Primitive& value)
{
  for (std::size_t i = 0; i < state.n_cells(); ++i) set_cell(state, gas, i, value);
}

void set_rest(const State& state, const Gas& gas, const Reference& reference, double length)
{
  set_equal_cells(state, 0.0, length);
  set_uniform(state, gas, {reference.density, 0.0, reference.pressure});
}

void set_acoustic_mode(const State& state, const Gas& gas, const Reference& reference, const AcousticMode& mode,
                       double time, double wall_x)
{
  set_equal_cells(state, 0.0, wall_x);
  const Primitive rest{reference.density, 0.0, reference.pressure};
  const double omega = mode.angular_frequency;
  const double k = omega / sound_speed(gas, rest);
  const double scale = omega * mode.amplitude / std::sin(k * mode.length);
  for (std::size_t i = 0; i < state.n_cells(); ++i) {
    const double centre = 0.5 * (state.node_x[i] + state.node_x[i + 1]);
    const double half = 0.5 * k * state.length[i];
    const double mean = std::sin(half) / half; // k > 0 and length > 0: see the preconditions
    const double p =
        reference.pressure - impedance(gas, rest) * scale * mean * std::cos(k * centre) * std::cos(omega * time);
    const double u = -scale * mean * std::sin(k * centre) * std::sin(omega * time);
    const double rho = reference.density * std::pow(p / reference.pressure, 1.0 / gas.gamma);
    set_cell(state, gas, i, {rho, u, p});
  }
}

} // namespace mullion::euler_1d
