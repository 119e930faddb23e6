#include "time_integration.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mullion::elastic_solid {
namespace {

SparseMatrix free_part(const SparseMatrix& matrix, const std::vector<Index>& free)
{
  std::vector<Index> number(static_cast<std::size_t>(matrix.cols()), -1);
  for (std::size_t i = 0; i < free.size(); ++i) number[static_cast<std::size_t>(free[i])] = static_cast<Index>(i);
  std::vector<Eigen::Triplet<double>> triplets;
  for (Eigen::Index j = 0; j < matrix.outerSize(); ++j)
    for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry) {
      const Index a = number[static_cast<std::size_t>(entry.row())], b = number[static_cast<std::size_t>(j)];
      if (a >= 0 && b >= 0) triplets.emplace_back(a, b, entry.value());
    }
  const auto n = static_cast<Eigen::Index>(free.size());
  SparseMatrix part(n, n);
  part.setFromTriplets(triplets.begin(), triplets.end());
  return part;
}

SparseMatrix effective_matrix(const System& s, const NewmarkParameters& p, double dt)
{
  const double damping = (1.0 - p.alpha_f) * p.gamma * dt, stiffness = (1.0 - p.alpha_f) * p.beta * dt * dt;
  return (1.0 - p.alpha_m + damping * s.rayleigh_mass) * s.mass +
         (stiffness + damping * s.rayleigh_stiffness) * s.stiffness;
}

/// F - K (u + a_1 v) - a_0 M v - M a, the last for the entries of a that are given.
Eigen::VectorXd imbalance(const System& s, const Eigen::VectorXd& load, const Eigen::VectorXd& u,
                          const Eigen::VectorXd& v, const Eigen::VectorXd& a)
{
  const Eigen::VectorXd elastic = u + s.rayleigh_stiffness * v, inertial = a + s.rayleigh_mass * v;
  Eigen::VectorXd rhs = load - s.stiffness * elastic;
  if (!inertial.isZero(0.0)) rhs -= s.mass * inertial;
  return rhs;
}

} // namespace

FreeSolver::FreeSolver(const SparseMatrix& matrix, const std::vector<Index>& free)
    : free_(free), factors_(std::make_unique<Eigen::SimplicialLDLT<SparseMatrix>>())
{
  if (free_.empty()) return;
  factors_->compute(free_part(matrix, free_));
  is_positive_ = factors_->info() == Eigen::Success && factors_->vectorD().minCoeff() > 0.0;
}

Eigen::VectorXd FreeSolver::solve(const Eigen::VectorXd& rhs) const
{
  Eigen::VectorXd full = Eigen::VectorXd::Zero(rhs.size());
  if (free_.empty()) return full;
  Eigen::VectorXd part(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) part[static_cast<Eigen::Index>(i)] = rhs[free_[i]];
  part = factors_->solve(part).eval();
  for (std::size_t i = 0; i < free_.size(); ++i) full[free_[i]] = part[static_cast<Eigen::Index>(i)];
  return full;
}

Eigen::VectorXd static_displacement(const System& system, const FreeSolver& stiffness, const Eigen::VectorXd& load,
                                    const Eigen::VectorXd& given)
{
  Eigen::VectorXd u = given;
  for (const Index i : system.free) u[i] = 0.0;
  return u + stiffness.solve(load - system.stiffness * u);
}

void balance_acceleration(const System& system, const FreeSolver& mass, Motion motion, const Eigen::VectorXd& load)
{
  Eigen::VectorXd a = motion.acceleration;
  for (const Index i : system.free) a[i] = 0.0;
  motion.acceleration = a + mass.solve(imbalance(system, load, motion.displacement, motion.velocity, a));
}

NewmarkParameters generalised_alpha(double rho_inf)
{
  const double alpha_m = (2.0 * rho_inf - 1.0) / (rho_inf + 1.0), alpha_f = rho_inf / (rho_inf + 1.0);
  const double sum = 1.0 - alpha_m + alpha_f;
  return {.beta = 0.25 * sum * sum, .gamma = 0.5 - alpha_m + alpha_f, .alpha_m = alpha_m, .alpha_f = alpha_f};
}

Newmark::Newmark(const System& system, const NewmarkParameters& parameters, double dt)
    : p_(parameters), dt_(dt), solver_(effective_matrix(system, parameters, dt), system.free)
{
}

void Newmark::step(const System& system, Motion motion, const Eigen::VectorXd& load_begin,
                   const Eigen::VectorXd& load_end, const Given& given) const
{
  const double dt = dt_, new_f = 1.0 - p_.alpha_f;
  const Eigen::VectorXd u = motion.displacement, v = motion.velocity, a = motion.acceleration;

  // At the end of the step: what is given, and of the free ones the part without the new acceleration.
  Eigen::VectorXd u_end = given.displacement, v_end = given.velocity, a_end = given.acceleration;
  for (const Index i : system.free) {
    u_end[i] = u[i] + dt * v[i] + dt * dt * (0.5 - p_.beta) * a[i];
    v_end[i] = v[i] + dt * (1.0 - p_.gamma) * a[i];
    a_end[i] = 0.0;
  }
  const Eigen::VectorXd rhs =
      p_.alpha_f == 0.0 && p_.alpha_m == 0.0
          ? imbalance(system, load_end, u_end, v_end, a_end)
          : imbalance(system, new_f * load_end + p_.alpha_f * load_begin, new_f * u_end + p_.alpha_f * u,
                      new_f * v_end + p_.alpha_f * v, (1.0 - p_.alpha_m) * a_end + p_.alpha_m * a);
  const Eigen::VectorXd found = solver_.solve(rhs);
  for (const Index i : system.free) {
    a_end[i] = found[i];
    u_end[i] += dt * dt * p_.beta * found[i];
    v_end[i] += dt * p_.gamma * found[i];
  }
  motion.displacement = u_end;
  motion.velocity = v_end;
  motion.acceleration = a_end;
}

void central_difference_step(const System& system, const FreeSolver& mass, Motion motion, double dt,
                             const Eigen::VectorXd& load_end, const Given& given)
{
  const Eigen::VectorXd v_half = motion.velocity + 0.5 * dt * motion.acceleration;
  Eigen::VectorXd u_end = motion.displacement + dt * v_half;
  std::vector<bool> is_free(static_cast<std::size_t>(u_end.size()), false);
  for (const Index i : system.free) is_free[static_cast<std::size_t>(i)] = true;
  Eigen::VectorXd a_given = Eigen::VectorXd::Zero(u_end.size());
  for (Eigen::Index i = 0; i < u_end.size(); ++i)
    if (!is_free[static_cast<std::size_t>(i)]) {
      u_end[i] = given.displacement[i];
      a_given[i] = given.acceleration[i];
    }
  const Eigen::VectorXd a_end = a_given + mass.solve(imbalance(system, load_end, u_end, v_half, a_given));
  for (Eigen::Index i = 0; i < u_end.size(); ++i)
    motion.velocity[i] = is_free[static_cast<std::size_t>(i)] ? v_half[i] + 0.5 * dt * a_end[i] : given.velocity[i];
  motion.displacement = u_end;
  motion.acceleration = a_end;
}

double highest_frequency(const System& system, const FreeSolver& mass)
{
  // A start with a part of every mode, and of the roughest ones a large one.
  Eigen::VectorXd x = Eigen::VectorXd::Zero(system.stiffness.rows());
  std::size_t k = 0;
  for (const Index i : system.free) {
    x[i] = (k % 2 == 0 ? 1.0 : -1.0) * (1.0 + 0.37 * std::sin(1.7 * static_cast<double>(k)));
    ++k;
  }
  constexpr int most = 20000;
  constexpr double tolerance = 1e-9; // of omega^2 from one iteration to the next: of omega some 1e-5 in all
  double squared = 0.0;
  for (int iteration = 0; iteration < most; ++iteration) {
    const Eigen::VectorXd image = system.stiffness * x;
    const Eigen::VectorXd inertia = system.mass * x;
    const double quotient = x.dot(image) / x.dot(inertia); // Rayleigh's: never above the highest
    const bool is_settled = std::abs(quotient - squared) <= tolerance * quotient;
    squared = quotient;
    if (is_settled) break;
    x = mass.solve(image);
    x /= x.cwiseAbs().maxCoeff();
  }
  return std::sqrt(std::max(squared, 0.0));
}

double numerical_frequency(double omega, double dt, const NewmarkParameters& p)
{
  const double x = 0.5 * omega * dt;
  if (p.gamma == 0.5 && p.alpha_m == 0.0 && p.alpha_f == 0.0) {
    const double sine = x / std::sqrt(1.0 + 4.0 * p.beta * x * x);
    return 2.0 / dt * std::asin(std::min(1.0, sine));
  }
  // The step's matrix for (u, dt v, dt^2 a), with Omega^2 = (omega dt)^2.
  const double squared = 4.0 * x * x, new_f = 1.0 - p.alpha_f;
  const double divisor = 1.0 - p.alpha_m + new_f * p.beta * squared;
  Eigen::Matrix3d step;
  const Eigen::RowVector3d u0(1.0, 1.0, 0.5 - p.beta), v0(0.0, 1.0, 1.0 - p.gamma);
  step.row(2) = (-squared * new_f * u0 - Eigen::RowVector3d(squared * p.alpha_f, 0.0, p.alpha_m)) / divisor;
  step.row(0) = u0 + p.beta * step.row(2);
  step.row(1) = v0 + p.gamma * step.row(2);
  double largest = 0.0, angle = std::numbers::pi;
  for (const auto& value : step.eigenvalues())
    if (value.imag() > 0.0 && std::abs(value) > largest) {
      largest = std::abs(value);
      angle = std::arg(value);
    }
  return angle / dt;
}

} // namespace mullion::elastic_solid
