#include "added_mass.hpp"

#include <Eigen/Dense>

#include <cmath>
#include <numbers>

namespace mullion::testing {

std::vector<std::vector<double>> monolithic_history(const AddedMassProblem& problem)
{
  using Eigen::MatrixXd, Eigen::VectorXd;
  const int n = problem.n_points;
  const double pi = std::numbers::pi, dx = problem.length / (n + 1), dt2 = problem.dt * problem.dt;
  const MatrixXd identity = MatrixXd::Identity(n, n);
  const VectorXd x = VectorXd::LinSpaced(n, dx, n * dx);

  MatrixXd sines(n, n);
  VectorXd mu(n);
  for (int k = 1; k <= n; ++k) {
    sines.col(k - 1) = std::sqrt(2.0 / (n + 1)) * (k * pi / problem.length * x).array().sin();
    mu(k - 1) = problem.length / (k * pi * std::tanh(k * pi * problem.radius / problem.length));
  }
  const MatrixXd mass = problem.solid_density * problem.thickness * identity +
                        problem.fluid_density * sines * mu.asDiagonal() * sines.transpose();
  MatrixXd stiffness = (problem.stiffness + 2.0 * problem.tension / (dx * dx)) * identity;
  stiffness.diagonal(1).setConstant(-problem.tension / (dx * dx));
  stiffness.diagonal(-1).setConstant(-problem.tension / (dx * dx));
  const VectorXd pulse = problem.pulse_pressure * (-4.0 * (x.array() - 1.5).square()).exp();
  const Eigen::LDLT<MatrixXd> system(mass / dt2 + stiffness);

  std::vector<std::vector<double>> history;
  VectorXd before = VectorXd::Zero(n), now = before;
  for (int step = 0; step <= problem.n_steps; ++step) {
    history.emplace_back(now.data(), now.data() + n);
    VectorXd load = mass * (2.0 * now - before) / dt2;
    if (step * problem.dt < problem.pulse_end) load += pulse;
    before = now;
    now = system.solve(load);
  }
  return history;
}

std::vector<double> monolithic_norms(double solid_density)
{
  std::vector<double> norms;
  for (const auto& eta : monolithic_history({.solid_density = solid_density})) {
    double squares = 0.0;
    for (const double e : eta) squares += e * e;
    norms.push_back(std::sqrt(squares));
  }
  return norms;
}

} // namespace mullion::testing
