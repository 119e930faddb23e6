// An elastic bar as equal linear elements with lumped mass: masses, internal forces, energies. No
// time integration.
#pragma once

#include <cstddef>
#include <span>

namespace mullion::elastic_bar {

enum class FarEnd {
  clamped, ///< the last node stays exactly where it is
  free,    ///< stress-free; the bar then has a rigid-body motion
};

/// A straight bar, Lagrangian X in [0, length]; node 0 at X = 0 carries the load (the interface),
/// the last node is the far end. Displacement and force are positive along +x, into the bar.
struct Bar {
  double density = 2700.0;       ///< rho_s, per reference volume [kg/m^3]
  double youngs_modulus = 2.8e6; ///< E_s [Pa]
  double length = 0.2;           ///< L_s [m]
  double area = 1.0;             ///< A [m^2]
  std::size_t n_elements = 10;   ///< equal linear elements
  FarEnd far_end = FarEnd::clamped;

  [[nodiscard]] std::size_t n_nodes() const { return n_elements + 1; }
  /// Nodes that can move: all, or all but the clamped one.
  [[nodiscard]] std::size_t n_free() const { return far_end == FarEnd::clamped ? n_elements : n_elements + 1; }
  [[nodiscard]] double element_length() const { return length / static_cast<double>(n_elements); }
  /// k = E_s A / dx [N/m].
  [[nodiscard]] double element_stiffness() const { return youngs_modulus * area / element_length(); }
  /// Lumped mass: rho_s A dx, half of it at the two ends [kg].
  [[nodiscard]] double nodal_mass(std::size_t node) const
  {
    const double element_mass = density * area * element_length();
    return node == 0 || node == n_elements ? 0.5 * element_mass : element_mass;
  }
};

/// Internal force on each node, f = K u, with K = (E_s A / dx) tridiag(-1, 2, -1), 1 instead of 2
/// at the ends.
///
/// At a clamped end the last entry is the reaction that holds it, and belongs to no equation of
/// motion.
///
/// @param displacement  n_nodes [m]
/// @param force         n_nodes [N], along +x; M a = F - f
void internal_force(const Bar& bar, std::span<const double> displacement, std::span<double> force);

/// Elastic energy sum_e k (u_{e+1} - u_e)^2 / 2 [J], elements in their order.
[[nodiscard]] double potential_energy(const Bar& bar, std::span<const double> displacement);

/// Kinetic energy sum_i m_i v_i^2 / 2 [J], nodes in their order.
[[nodiscard]] double kinetic_energy(const Bar& bar, std::span<const double> velocity);

/// Acceleration in equilibrium with a load at node 0: a = M^-1 (F e_0 - K u); 0 at a clamped node.
///
/// Gives a^0 at the start of a run, and a^{n+1} after a step with a mean load.
///
/// @param displacement  n_nodes [m]
/// @param load          F = A (P_s - p_ref), compression positive, pushes node 0 along +x [N]
/// @param acceleration  n_nodes [m/s^2]
void equilibrium_acceleration(const Bar& bar, std::span<const double> displacement, double load,
                              std::span<double> acceleration);

/// Work of the load that the integrator used over a step, Pbar du [J]; positive when it feeds the
/// bar.
///
/// Newmark (1/4, 1/2) with the load F^{n+1}: Pbar = (F^n + F^{n+1}) / 2, with a mean load: that
/// load. Either way it is the change of the bar's energy to round-off. Velocity Verlet: Pbar as for
/// Newmark; the energy then follows up to a bounded O(dt^2) term only.
///
/// @param mean_load  Pbar [N]
/// @param u_begin, u_end  displacement of node 0 before and after the step [m]
inline double interface_work(double mean_load, double u_begin, double u_end) { return mean_load * (u_end - u_begin); }

} // namespace mullion::elastic_bar
