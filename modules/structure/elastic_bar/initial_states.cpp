// Rest and standing waves.
#include "initial_states.hpp"

#include <cmath>

namespace mullion::elastic_bar {

void set_rest(const Bar& bar, const Motion& motion, double load)
{
  for (std::size_t i = 0; i < bar.n_nodes(); ++i) {
    motion.displacement[i] = 0.0;
    motion.velocity[i] = 0.0;
  }
  equilibrium_acceleration(bar, motion.displacement, load, motion.acceleration);
}

void set_mode(const Bar& bar, const Motion& motion, double amplitude, double angular_frequency, double load)
{
  const bool is_clamped = bar.far_end == FarEnd::clamped;
  const double wave_number = angular_frequency / std::sqrt(bar.youngs_modulus / bar.density);
  const auto shape = [&](double from_far_end) {
    const double phase = wave_number * from_far_end;
    return is_clamped ? std::sin(phase) : std::cos(phase);
  };
  const double scale = amplitude / shape(bar.length);
  for (std::size_t i = 0; i < bar.n_nodes(); ++i) {
    const auto n_to_far_end = static_cast<double>(bar.n_elements - i); // exactly 0 at the far end
    motion.displacement[i] = scale * shape(n_to_far_end * bar.element_length());
    motion.velocity[i] = 0.0;
  }
  equilibrium_acceleration(bar, motion.displacement, load, motion.acceleration);
}

} // namespace mullion::elastic_bar
