// The calorically perfect gas in any number of dimensions: point values, amounts per volume, and the algebra between
// them. No cells, no faces, no time.
#pragma once

#include <Eigen/Core>

#include <array>
#include <cmath>
#include <cstddef>

namespace mullion::euler {

/// A calorically perfect gas, p = (gamma - 1) rho e.
struct Gas {
  double gamma = 1.4; ///< ratio of specific heats [1]
};

template <int D> using Vec = Eigen::Matrix<double, D, 1>;

template <int D> inline constexpr int n_values = D + 2;

/// Density, D components of velocity, pressure: (rho, u, p), or the conserved (rho, rho u, rho E), or amounts of
/// these in a cell [kg, kg m/s, J; per metre of depth in the plane].
template <int D> using Values = std::array<double, n_values<D>>;

/// u . u of (rho, u, p), or of the momentum of conserved values.
template <int D> inline double square_of_velocity(const Values<D>& w)
{
  double sum = 0.0;
  for (int d = 1; d <= D; ++d) sum += w[d] * w[d];
  return sum;
}

/// (rho, rho u, rho E) of (rho, u, p).
template <int D> inline Values<D> conserved(const Gas& gas, const Values<D>& w)
{
  Values<D> c;
  c[0] = w[0];
  for (int d = 1; d <= D; ++d) c[d] = w[0] * w[d];
  c[D + 1] = w[D + 1] / (gas.gamma - 1.0) + 0.5 * w[0] * square_of_velocity<D>(w);
  return c;
}

/// (rho, u, p) of amounts in a volume; T: a number, or several at a time. Not checked: see is_gas().
template <int D, class T>
[[gnu::always_inline]] inline std::array<T, n_values<D>>
primitive(const Gas& gas, const std::array<T, n_values<D>>& amounts, const T& volume)
{
  std::array<T, n_values<D>> w;
  const T per_volume = 1.0 / volume;
  const T per_mass = 1.0 / amounts[0];
  w[0] = amounts[0] * per_volume;
  T kinetic{};
  for (int d = 1; d <= D; ++d) {
    w[d] = amounts[d] * per_mass;
    kinetic += amounts[d] * w[d];
  }
  w[D + 1] = (gas.gamma - 1.0) * (amounts[D + 1] - 0.5 * kinetic) * per_volume;
  return w;
}

/// Positive density and pressure; false also for values that are no numbers.
template <int D> inline bool is_gas(const Values<D>& w) { return w[0] > 0.0 && w[D + 1] > 0.0; }

/// c = sqrt(gamma p / rho) [m/s].
template <int D> inline double sound_speed(const Gas& gas, const Values<D>& w)
{
  return std::sqrt(gas.gamma * w[D + 1] / w[0]);
}

/// u . n
template <int D> inline double along(const Values<D>& w, const double* n)
{
  double sum = 0.0;
  for (int d = 0; d < D; ++d) sum += w[d + 1] * n[d];
  return sum;
}

/// What a single state carries through a face of unit normal n that moves with s along it, per area and time:
/// (rho (u_n - s), rho u (u_n - s) + p n, rho E (u_n - s) + p u_n).
template <int D> inline Values<D> physical_flux(const Gas& gas, const Values<D>& w, const double* n, double s)
{
  const auto c = conserved<D>(gas, w);
  const double u_n = along<D>(w, n);
  const double through = u_n - s;
  Values<D> f;
  f[0] = c[0] * through;
  for (int d = 0; d < D; ++d) f[d + 1] = c[d + 1] * through + w[D + 1] * n[d];
  f[D + 1] = c[D + 1] * through + w[D + 1] * u_n;
  return f;
}

} // namespace mullion::euler
