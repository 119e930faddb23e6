// Newmark's method on the tridiagonal system, and velocity Verlet.
#include "newmark.hpp"

#include <cstddef>

namespace mullion::elastic_bar {

Newmark::Newmark(const Bar& bar, double dt)
    : bar_(bar), dt_(dt), pivot_(bar.n_free()), multiplier_(bar.n_free()), rhs_(bar.n_nodes()),
      predicted_(bar.n_nodes())
{
  // L D L^T without pivoting: the matrix is symmetric and diagonally dominant, so every pivot
  // exceeds its mass.
  const double coupling = 0.25 * dt * dt * bar.element_stiffness();
  for (std::size_t i = 0; i < bar.n_free(); ++i) {
    const double n_neighbours = i == 0 || i == bar.n_elements ? 1.0 : 2.0;
    pivot_[i] = bar.nodal_mass(i) + n_neighbours * coupling;
    if (i > 0) {
      multiplier_[i] = -coupling / pivot_[i - 1];
      pivot_[i] += multiplier_[i] * coupling;
    }
  }
}

void Newmark::solve(std::span<double> rhs) const
{
  const std::size_t n = pivot_.size();
  for (std::size_t i = 1; i < n; ++i) rhs[i] -= multiplier_[i] * rhs[i - 1];
  for (std::size_t i = 0; i < n; ++i) rhs[i] /= pivot_[i];
  for (std::size_t i = n - 1; i > 0; --i) rhs[i - 1] -= multiplier_[i] * rhs[i];
}

void Newmark::step(const Motion& motion, double load_end)
{
  const auto& [u, v, a] = motion;
  const std::size_t n = bar_.n_free();
  for (std::size_t i = 0; i < n; ++i) predicted_[i] = u[i] + dt_ * v[i] + 0.25 * dt_ * dt_ * a[i];

  internal_force(bar_, predicted_, rhs_);
  for (std::size_t i = 0; i < n; ++i) rhs_[i] = -rhs_[i];
  rhs_[0] += load_end;
  solve(rhs_); // now a^{n+1}

  for (std::size_t i = 0; i < n; ++i) {
    u[i] = predicted_[i] + 0.25 * dt_ * dt_ * rhs_[i];
    v[i] += 0.5 * dt_ * (a[i] + rhs_[i]);
    a[i] = rhs_[i];
  }
}

void Newmark::step_mean(const Motion& motion, double mean_load)
{
  const auto& [u, v, a] = motion;
  const std::size_t n = bar_.n_free();
  for (std::size_t i = 0; i < n; ++i) predicted_[i] = u[i] + 0.5 * dt_ * v[i];

  internal_force(bar_, predicted_, rhs_);
  for (std::size_t i = 0; i < n; ++i) rhs_[i] = -dt_ * rhs_[i];
  rhs_[0] += dt_ * mean_load;
  solve(rhs_); // now v^{n+1} - v

  for (std::size_t i = 0; i < n; ++i) {
    u[i] += dt_ * (v[i] + 0.5 * rhs_[i]);
    v[i] += rhs_[i];
  }
  equilibrium_acceleration(bar_, u, mean_load, a);
}

void central_difference_displacement(const Bar& bar, const Motion& motion, double dt)
{
  for (std::size_t i = 0; i < bar.n_free(); ++i)
    motion.displacement[i] += dt * motion.velocity[i] + 0.5 * dt * dt * motion.acceleration[i];
}

void central_difference_velocity(const Bar& bar, const Motion& motion, double dt, double load_end)
{
  const auto& [u, v, a] = motion;
  // The sum of both accelerations enters v, but a is overwritten in between: two half kicks.
  for (std::size_t i = 0; i < bar.n_free(); ++i) v[i] += 0.5 * dt * a[i];
  equilibrium_acceleration(bar, u, load_end, a);
  for (std::size_t i = 0; i < bar.n_free(); ++i) v[i] += 0.5 * dt * a[i];
}

void central_difference_step(const Bar& bar, const Motion& motion, double dt, double load_end)
{
  central_difference_displacement(bar, motion, dt);
  central_difference_velocity(bar, motion, dt, load_end);
}

void central_difference_step_mean(const Bar& bar, const Motion& motion, double dt, double mean_load)
{
  equilibrium_acceleration(bar, motion.displacement, mean_load, motion.acceleration);
  central_difference_step(bar, motion, dt, mean_load);
}

} // namespace mullion::elastic_bar
