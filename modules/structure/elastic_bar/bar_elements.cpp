// Linear bar elements with lumped mass.
#include "bar_elements.hpp"

namespace mullion::elastic_bar {

void internal_force(const Bar& bar, std::span<const double> displacement, std::span<double> force)
{
  const double k = bar.element_stiffness();
  double pull_from_left = 0.0; // k (u_i - u_{i-1}), the tension in the element on the left
  for (std::size_t i = 0; i < bar.n_elements; ++i) {
    const double tension = k * (displacement[i + 1] - displacement[i]);
    force[i] = pull_from_left - tension;
    pull_from_left = tension;
  }
  force[bar.n_elements] = pull_from_left;
}

double potential_energy(const Bar& bar, std::span<const double> displacement)
{
  const double k = bar.element_stiffness();
  double sum = 0.0;
  for (std::size_t e = 0; e < bar.n_elements; ++e) {
    const double stretch = displacement[e + 1] - displacement[e];
    sum += 0.5 * k * stretch * stretch;
  }
  return sum;
}

double kinetic_energy(const Bar& bar, std::span<const double> velocity)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < bar.n_nodes(); ++i) sum += 0.5 * bar.nodal_mass(i) * velocity[i] * velocity[i];
  return sum;
}

void equilibrium_acceleration(const Bar& bar, std::span<const double> displacement, double load,
                              std::span<double> acceleration)
{
  internal_force(bar, displacement, acceleration);
  for (std::size_t i = 0; i < bar.n_free(); ++i) {
    const double external = i == 0 ? load : 0.0;
    acceleration[i] = (external - acceleration[i]) / bar.nodal_mass(i);
  }
  if (bar.far_end == FarEnd::clamped) acceleration[bar.n_elements] = 0.0;
}

} // namespace mullion::elastic_bar
