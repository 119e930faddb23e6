#include "implicit_euler.hpp"

#include <cmath>
#include <vector>

namespace mullion::string_1d {

double pulse_pressure(const Pulse& pulse, double x, double t_begin)
{
  return t_begin < pulse.end ? pulse.pressure * std::exp(-4.0 * (x - 1.5) * (x - 1.5)) : 0.0;
}

void implicit_euler(const ElasticString& string, std::span<const double> pressure, std::span<const double> now,
                    std::span<const double> before, double dt, std::span<double> next)
{
  const std::size_t n = string.n_points;
  const double inertia = string.mass_per_area() / (dt * dt);
  const double off_diagonal = -string.tension / (string.dx() * string.dx());
  const double diagonal = inertia + string.stiffness - 2.0 * off_diagonal;
  // Without pivoting: the matrix is diagonally dominant, so every pivot exceeds |off_diagonal|.
  std::vector<double> pivot(n, diagonal);
  for (std::size_t i = 0; i < n; ++i) {
    next[i] = pressure[i] + inertia * (2.0 * now[i] - before[i]);
    if (i == 0) continue;
    const double multiplier = off_diagonal / pivot[i - 1];
    pivot[i] -= multiplier * off_diagonal;
    next[i] -= multiplier * next[i - 1];
  }
  next[n - 1] /= pivot[n - 1];
  for (std::size_t i = n - 1; i > 0; --i) next[i - 1] = (next[i - 1] - off_diagonal * next[i]) / pivot[i - 1];
}

double kinetic_energy(const ElasticString& string, std::span<const double> velocity)
{
  double sum = 0.0;
  for (const double v : velocity) sum += v * v;
  return 0.5 * string.mass_per_area() * sum * string.dx();
}

double elastic_energy(const ElasticString& string, std::span<const double> displacement)
{
  double squares = 0.0, slopes = 0.0, left = 0.0;
  for (const double eta : displacement) {
    const double slope = (eta - left) / string.dx();
    squares += eta * eta;
    slopes += slope * slope;
    left = eta;
  }
  const double last_slope = -left / string.dx();
  slopes += last_slope * last_slope;
  return 0.5 * (string.stiffness * squares + string.tension * slopes) * string.dx();
}

double work(const ElasticString& string, std::span<const double> pressure, std::span<const double> next,
            std::span<const double> now)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < string.n_points; ++i) sum += pressure[i] * (next[i] - now[i]);
  return sum * string.dx();
}

} // namespace mullion::string_1d
