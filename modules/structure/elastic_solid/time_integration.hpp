// Motion of a solid in time: M a + C v + K u = F with some displacements given. Newmark's family and generalised alpha
// (implicit, one factorisation for all steps of a length) and central differences (explicit).
//
// All vectors have an entry for each degree of freedom. Those that are held or moved are not unknown: their
// displacement, velocity and acceleration are `Given`.
#pragma once

#include "solid.hpp"

#include <Eigen/Core>
#include <Eigen/SparseCholesky>

#include <memory>
#include <vector>

namespace mullion::elastic_solid {

/// What the equations of motion consist of.
struct System {
  SparseMatrix stiffness, mass;    ///< K [N/m], M [kg], of all degrees of freedom
  double rayleigh_mass = 0.0;      ///< a_0 of C = a_0 M + a_1 K [1/s]
  double rayleigh_stiffness = 0.0; ///< a_1 [s]
  std::vector<Index> free = {};    ///< the unknown degrees of freedom, ascending
};

/// In memory of the caller.
struct Motion {
  Eigen::Ref<Eigen::VectorXd> displacement; ///< u [m]
  Eigen::Ref<Eigen::VectorXd> velocity;     ///< v [m/s]
  Eigen::Ref<Eigen::VectorXd> acceleration; ///< a [m/s^2]
};

/// Motion of the degrees of freedom that are not free; other entries are not read.
struct Given {
  Eigen::VectorXd displacement, velocity, acceleration;
};

/// A x = b for the free degrees of freedom, factorised once: A_ff = L D L^T.
class FreeSolver {
public:
  FreeSolver(const SparseMatrix& matrix, const std::vector<Index>& free);

  /// All pivots are positive: the matrix is positive definite.
  [[nodiscard]] bool is_positive() const { return is_positive_; }
  /// Free entries of the result solve the system with the free entries of `rhs`; the others are 0.
  [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;

private:
  std::vector<Index> free_;
  std::unique_ptr<Eigen::SimplicialLDLT<SparseMatrix>> factors_;
  bool is_positive_ = false;
};

/// K u = F on the free degrees of freedom, the others given. @param stiffness  solver of K
[[nodiscard]] Eigen::VectorXd static_displacement(const System& system, const FreeSolver& stiffness,
                                                  const Eigen::VectorXd& load, const Eigen::VectorXd& given);

/// The acceleration in balance with a load: M a = F - C v - K u; where a is not free it is left alone.
/// @param mass  solver of M
void balance_acceleration(const System& system, const FreeSolver& mass, Motion motion, const Eigen::VectorXd& load);

/// Members of Newmark's family with the extension of Chung & Hulbert 1993.
struct NewmarkParameters {
  double beta = 0.25, gamma = 0.5;
  double alpha_m = 0.0, alpha_f = 0.0; ///< shares of the old acceleration, and of the old displacement and load
};

/// Generalised alpha with spectral radius rho_inf of the highest frequencies, in [0, 1]: second order,
/// unconditionally stable; alpha_m = (2 rho - 1)/(rho + 1), alpha_f = rho/(rho + 1), gamma = 1/2 - alpha_m + alpha_f,
/// beta = (1 - alpha_m + alpha_f)^2/4.
[[nodiscard]] NewmarkParameters generalised_alpha(double rho_inf);

/// One step of Newmark 1959, or of generalised alpha:
///
///     M ((1 - alpha_m) a' + alpha_m a) + C (…)_f + K ((1 - alpha_f) u' + alpha_f u) = (1 - alpha_f) F' + alpha_f F
///     u' = u + dt v + dt^2 ((1/2 - beta) a + beta a'),  v' = v + dt ((1 - gamma) a + gamma a')
///
/// Holds the factors of (1 - alpha_m) M + (1 - alpha_f)(gamma dt C + beta dt^2 K), a function of system and dt alone.
/// beta = 1/4, gamma = 1/2 without damping: E' - E = (F + F')/2 (u' - u) to round-off, provided M a = F - K u before.
class Newmark {
public:
  Newmark(const System& system, const NewmarkParameters& parameters, double dt);

  [[nodiscard]] double dt() const { return dt_; }
  /// @param system      as at construction
  /// @param motion      advanced in place
  /// @param load_begin  F, read where alpha_f is not 0
  /// @param load_end    F' [N]
  /// @param given       at the end of the step
  void step(const System& system, Motion motion, const Eigen::VectorXd& load_begin, const Eigen::VectorXd& load_end,
            const Given& given) const;

private:
  NewmarkParameters p_;
  double dt_;
  FreeSolver solver_;
};

/// One step of central differences as velocity Verlet:
///
///     u' = u + dt v + dt^2/2 a,  M a' = F' - K u' - C (v + dt/2 a),  v' = v + dt/2 (a + a')
///
/// The displacement does not depend on F'. Damping takes the velocity of half the step.
/// @param mass  solver of M
void central_difference_step(const System& system, const FreeSolver& mass, Motion motion, double dt,
                             const Eigen::VectorXd& load_end, const Given& given);

/// The highest angular frequency of the free degrees of freedom [rad/s], by power iteration on M^-1 K, from below;
/// central differences are stable for dt < 2/omega_max.
/// @param mass  solver of M
[[nodiscard]] double highest_frequency(const System& system, const FreeSolver& mass);

/// The angular frequency with which Newmark's family runs a free oscillation of angular frequency omega [rad/s].
///
/// gamma = 1/2, no alphas: (2/dt) asin(x/sqrt(1 + 4 beta x^2)), x = omega dt/2; otherwise that of the amplification
/// matrix. Beyond the limit of stability: pi/dt.
[[nodiscard]] double numerical_frequency(double omega, double dt, const NewmarkParameters& parameters);

} // namespace mullion::elastic_solid
