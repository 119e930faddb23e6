// Time integration of the bar: Newmark's average-acceleration method (implicit) and central
// differences (explicit Newmark, velocity Verlet), each with a load at the end of the step or a
// load that is constant over it.
#pragma once

#include "bar_elements.hpp"

#include <span>
#include <vector>

namespace mullion::elastic_bar {

/// Motion of all nodes, in memory of the caller: n_nodes entries each. A clamped node holds zeros.
struct Motion {
  std::span<double> displacement; ///< u [m]
  std::span<double> velocity;     ///< v [m/s]
  std::span<double> acceleration; ///< a [m/s^2]
};

/// Newmark with beta = 1/4, gamma = 1/2: second order, unconditionally stable, keeps the energy to
/// round-off.
///
/// Holds the factorised tridiagonal matrix and scratch memory, both functions of bar and dt alone:
/// no history. After either step the acceleration is the one in equilibrium with the load that the
/// step used; the recursion a^{n+1} = 2 a_m - a^n would ring.
class Newmark {
public:
  /// Factorises M + dt^2/4 K = L D L^T. O(n_nodes).
  ///
  /// @param dt  step [s], > 0
  Newmark(const Bar& bar, double dt);

  [[nodiscard]] double dt() const { return dt_; }

  /// Step with the load at the end of the step; that at its begin is in the acceleration.
  ///
  ///     (M + dt^2/4 K) a^{n+1} = F^{n+1} - K (u + dt v + dt^2/4 a)
  ///     u^{n+1} = u + dt v + dt^2/4 (a + a^{n+1}),  v^{n+1} = v + dt/2 (a + a^{n+1})      Newmark
  ///     1959
  ///
  /// @param motion    advanced in place
  /// @param load_end  F^{n+1} on node 0, along +x [N]
  /// @pre   M a = F^n - K u, i.e. equilibrium_acceleration() at the start
  /// @post  E^{n+1} - E^n = (F^n + F^{n+1}) / 2 (u_0^{n+1} - u_0^n) to round-off
  void step(const Motion& motion, double load_end);

  /// Step with a load that is constant over the step, e.g. known at its middle.
  ///
  ///     (M + dt^2/4 K) (v^{n+1} - v) = dt (F - K (u + dt/2 v)),  u^{n+1} = u + dt/2 (v + v^{n+1})
  ///     a^{n+1} := M^-1 (F - K u^{n+1})
  ///
  /// @param mean_load  F on node 0, along +x [N]
  /// @post  E^{n+1} - E^n = F (u_0^{n+1} - u_0^n) to round-off; motion.acceleration is written, not
  /// read
  void step_mean(const Motion& motion, double mean_load);

private:
  void solve(std::span<double> rhs) const; // the first n_free entries, in place

  Bar bar_;
  double dt_;
  std::vector<double> pivot_;      // D
  std::vector<double> multiplier_; // L below the diagonal: row i, column i - 1
  std::vector<double> rhs_, predicted_;
};

/// Central differences (Newmark beta = 0, gamma = 1/2) in two halves, because a lag-free scheme
/// moves the fluid between them: first half, the displacement.
///
///     u^{n+1} = u + dt v + dt^2/2 a
///
/// Stable for c_s dt / dx <= 1, c_s = sqrt(E_s / rho_s).
void central_difference_displacement(const Bar& bar, const Motion& motion, double dt);

/// Second half: the new acceleration and the velocity, from the load at the end of the step.
///
///     a^{n+1} = M^-1 (F^{n+1} - K u^{n+1}),  v^{n+1} = v + dt/2 (a + a^{n+1})
void central_difference_velocity(const Bar& bar, const Motion& motion, double dt, double load_end);

/// Both halves: one step with the load F^{n+1} [N].
///
/// @pre  as Newmark::step()
void central_difference_step(const Bar& bar, const Motion& motion, double dt, double load_end);

/// One step with a load that is constant over it: a^n is taken in equilibrium with that load too
/// [N].
void central_difference_step_mean(const Bar& bar, const Motion& motion, double dt, double mean_load);

} // namespace mullion::elastic_bar
