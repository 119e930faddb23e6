// The generalised string, the wall of the model problem of Causin, Gerbeau, Nobile 2005, and one step of it by implicit
// Euler on central differences in space.
//
//     rho_s h eta_tt + a eta - b eta_xx = p + p_e,   eta = 0 at both ends
//
// eta is positive out of the fluid; p is what the fluid exerts on the string, p_e a given pulse. All for 1 m of depth.
#pragma once

#include <cstddef>
#include <span>

namespace mullion::string_1d {

/// The points are x_i = i dx, i = 1 … n_points, dx = L / (n_points + 1): the ends do not move and are left out.
struct ElasticString {
  std::size_t n_points;
  double length;    ///< L [m]
  double thickness; ///< h [m]
  double density;   ///< rho_s, mass per volume of the wall [kg/m^3]
  double stiffness; ///< a, against displacement [Pa/m]
  double tension;   ///< b [Pa m]

  [[nodiscard]] double dx() const { return length / static_cast<double>(n_points + 1); }
  [[nodiscard]] double mass_per_area() const { return density * thickness; } ///< rho_s h [kg/m^2]
};

/// The pulse, a bump around x = 1.5 m that pushes as long as the step begins before `end`.
///
///     p_e = p_0 exp(-4 (x - 1.5)^2) while t^n < end, else 0
struct Pulse {
  double pressure; ///< p_0 [Pa]
  double end;      ///< [s]
};

/// p_e at a point [Pa]. @param x along the string [m] @param t_begin t^n, the begin of the step [s]
[[nodiscard]] double pulse_pressure(const Pulse& pulse, double x, double t_begin);

/// One step of implicit Euler: a tridiagonal system, by Thomas' algorithm.
///
///     (rho_s h / dt^2 + a) eta_i - b (eta_{i+1} - 2 eta_i + eta_{i-1}) / dx^2
///         = p_i + rho_s h (2 eta^n - eta^{n-1})_i / dt^2,   eta = eta^{n+1}
///
/// @param pressure  n_points, all that acts at the end of the step, p + p_e [Pa]
/// @param now       n_points, eta^n [m]
/// @param before    n_points, eta^{n-1} [m]
/// @param dt        step, the same as the one before [s]
/// @param next      n_points, eta^{n+1} [m]
void implicit_euler(const ElasticString& string, std::span<const double> pressure, std::span<const double> now,
                    std::span<const double> before, double dt, std::span<double> next);

/// rho_s h / 2 sum_i v_i^2 dx [J]. @param velocity n_points [m/s]
[[nodiscard]] double kinetic_energy(const ElasticString& string, std::span<const double> velocity);

/// a / 2 sum_i eta_i^2 dx + b / 2 sum_i ((eta_{i+1} - eta_i) / dx)^2 dx, the fixed ends included [J].
[[nodiscard]] double elastic_energy(const ElasticString& string, std::span<const double> displacement);

/// Work of a pressure over a step, p . (eta^{n+1} - eta^n) dx [J].
[[nodiscard]] double work(const ElasticString& string, std::span<const double> pressure, std::span<const double> next,
                          std::span<const double> now);

} // namespace mullion::string_1d
