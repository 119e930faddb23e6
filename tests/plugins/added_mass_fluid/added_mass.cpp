#include "added_mass.hpp"

#include <cmath>
#include <numbers>

namespace mullion::added_mass_fluid {

double eigenvalue(const Channel& channel, std::size_t mode)
{
  const double k_pi = static_cast<double>(mode) * std::numbers::pi;
  return channel.length / (k_pi * std::tanh(k_pi * channel.radius / channel.length));
}

std::vector<double> added_mass_matrix(const Channel& channel)
{
  const std::size_t n = channel.n_points;
  const double intervals = static_cast<double>(n + 1);
  std::vector<double> matrix(n * n, 0.0), s(n);
  for (std::size_t k = 1; k <= n; ++k) {
    for (std::size_t i = 0; i < n; ++i)
      s[i] = std::sqrt(2.0 / intervals) * std::sin(static_cast<double>(k * (i + 1)) * std::numbers::pi / intervals);
    const double mu = eigenvalue(channel, k);
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = 0; i < n; ++i) matrix[j * n + i] += mu * (s[i] * s[j]);
  }
  return matrix;
}

void wall_pressure(const Channel& channel, std::span<const double> matrix, const WallMotion& motion, double dt,
                   std::span<double> pressure)
{
  const std::size_t n = channel.n_points;
  const auto& [next, now, before] = motion;
  for (double& p : pressure) p = 0.0;
  // Column by column: each sum runs in the order of the points, whatever the compiler makes of the inner loop.
  for (std::size_t j = 0; j < n; ++j) {
    const double acceleration = (next[j] - 2.0 * now[j] + before[j]) / (dt * dt);
    for (std::size_t i = 0; i < n; ++i) pressure[i] -= channel.density * matrix[j * n + i] * acceleration;
  }
}

double wall_work(const Channel& channel, std::span<const double> pressure, const WallMotion& motion)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < channel.n_points; ++i) sum += pressure[i] * (motion.next[i] - motion.now[i]);
  return sum * channel.dx();
}

} // namespace mullion::added_mass_fluid
