// Added mass of the flow in a channel, as its wall feels it: the fluid of the model problem of Causin, Gerbeau, Nobile
// 2005, where the ratio of this mass to that of the wall decides which coupling schemes work.
//
// The flow is a potential flow, incompressible and without viscosity, in [0, L] x [0, R]: nothing flows through the
// axis y = 0, the pressure vanishes at both ends, and the wall at y = R moves up by eta. Then p = -rho_f M_A eta_tt.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mullion::added_mass_fluid {

/// The wall's points are x_i = i dx, i = 1 … n_points, dx = L / (n_points + 1): the ends do not move and are left out.
struct Channel {
  std::size_t n_points;
  double length;  ///< L [m]
  double radius;  ///< R, from the axis to the wall [m]
  double density; ///< rho_f [kg/m^3]

  [[nodiscard]] double dx() const { return length / static_cast<double>(n_points + 1); }
};

/// Eigenvalue of M_A [m], mode = 1 for the longest wave: phi = cosh(kappa y) sin(kappa x), kappa = mode pi / L, gives
///
///     mu_k = phi / phi_y at y = R = L / (k pi tanh(k pi R / L))                    Causin, Gerbeau, Nobile 2005
[[nodiscard]] double eigenvalue(const Channel& channel, std::size_t mode);

/// M_A = sum_k mu_k s_k s_k^T, (s_k)_i = sqrt(2 / (n + 1)) sin(k pi i / (n + 1)), k = 1 … n.
///
/// @return  (n_points x n_points), column after column, symmetric to the bit [m]
[[nodiscard]] std::vector<double> added_mass_matrix(const Channel& channel);

/// Displacement of the wall at three instants that lie dt apart; n_points each [m], positive out of the fluid.
struct WallMotion {
  std::span<const double> next;   ///< eta^{n+1}
  std::span<const double> now;    ///< eta^n
  std::span<const double> before; ///< eta^{n-1}
};

/// Pressure on the wall at the end of the step.
///
///     p^{n+1} = -rho_f M_A (eta^{n+1} - 2 eta^n + eta^{n-1}) / dt^2
///
/// @param matrix    M_A as added_mass_matrix() returns it
/// @param dt        step, the same as the one before [s]
/// @param pressure  n_points [Pa]
void wall_pressure(const Channel& channel, std::span<const double> matrix, const WallMotion& motion, double dt,
                   std::span<double> pressure);

/// Work of the pressure on the wall in this step, p^{n+1} . (eta^{n+1} - eta^n) dx [J for 1 m of depth].
[[nodiscard]] double wall_work(const Channel& channel, std::span<const double> pressure, const WallMotion& motion);

} // namespace mullion::added_mass_fluid
