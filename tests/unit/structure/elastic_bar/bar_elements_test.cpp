// Bar elements: forces, static solution, energies, frequencies.
#include "elastic_bar/bar_elements.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>
#include <vector>

using namespace mullion::elastic_bar;

namespace {

// Lowest frequency of the element matrices [rad/s].
double lowest_frequency(const Bar& bar)
{
  const auto n = static_cast<Eigen::Index>(bar.n_free());
  Eigen::MatrixXd stiffness(n, n);
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(n, n);
  std::vector<double> unit(bar.n_nodes()), force(bar.n_nodes());
  for (Eigen::Index j = 0; j < n; ++j) {
    unit.assign(bar.n_nodes(), 0.0);
    unit[static_cast<std::size_t>(j)] = 1.0;
    internal_force(bar, unit, force);
    for (Eigen::Index i = 0; i < n; ++i)
      stiffness(i, j) = force[static_cast<std::size_t>(i)];
    mass(j, j) = bar.nodal_mass(static_cast<std::size_t>(j));
  }
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness, mass);
  return std::sqrt(solver.eigenvalues()(0));
}

} // namespace

TEST_CASE("the element masses add up to the mass of the bar")
{
  const Bar bar{.density = 260.0, .length = 0.3, .area = 2.0, .n_elements = 7};
  double sum = 0.0;
  for (std::size_t i = 0; i < bar.n_nodes(); ++i)
    sum += bar.nodal_mass(i);

  CHECK(sum == doctest::Approx(260.0 * 0.3 * 2.0).epsilon(1e-14));
}

TEST_CASE("patch test: a linear displacement has forces at the ends only, and they are E A strain")
{
  const Bar bar{
      .youngs_modulus = 1e6, .length = 2.0, .area = 3.0, .n_elements = 5, .far_end = FarEnd::free};
  std::vector<double> u(6), f(6);
  for (std::size_t i = 0; i < 6; ++i)
    u[i] = 0.1 - 1e-3 * 0.4 * static_cast<double>(i); // strain -1e-3: compression

  internal_force(bar, u, f);

  const double expected = 1e6 * 3.0 * 1e-3; // pushes back against a load along +x
  CHECK(f[0] == doctest::Approx(expected).epsilon(1e-12));
  CHECK(f[5] == doctest::Approx(-expected).epsilon(1e-12));
  for (std::size_t i = 1; i < 5; ++i)
    CHECK(std::abs(f[i]) < 1e-12 * 1e6 * 3.0 * 0.1 / 0.4); // round-off of k u
}

TEST_CASE("the static solution under an end load has no acceleration")
{
  const Bar bar{.youngs_modulus = 1e6, .length = 2.0, .area = 3.0, .n_elements = 4};
  const double load = 600.0;
  std::vector<double> u(5), a(5, 1.0);
  for (std::size_t i = 0; i < 5; ++i)
    u[i] = load * (2.0 - 0.5 * static_cast<double>(i)) / (1e6 * 3.0); // F (L_s - X) / (E A)

  equilibrium_acceleration(bar, u, load, a);

  for (const double a_i : a)
    CHECK(std::abs(a_i) < 1e-13 * load / bar.nodal_mass(0)); // round-off
  CHECK(a[4] == 0.0);                                        // clamped: exactly
  CHECK(potential_energy(bar, u) == doctest::Approx(0.5 * load * u[0]).epsilon(1e-14)); // Clapeyron
}

TEST_CASE("a suddenly loaded bar at rest accelerates its first node by load over mass")
{
  const Bar bar{.density = 100.0, .length = 1.0, .n_elements = 4};
  const std::vector<double> u(5, 0.0);
  std::vector<double> a(5, 7.0);

  equilibrium_acceleration(bar, u, 50.0, a);

  CHECK(a == std::vector<double>{50.0 / 12.5, 0.0, 0.0, 0.0, 0.0});
}

TEST_CASE("the kinetic energy of a bar that moves as a whole is half its mass times speed squared")
{
  const Bar bar{.density = 100.0, .length = 1.0, .n_elements = 4, .far_end = FarEnd::free};
  const std::vector<double> v(5, 3.0);

  CHECK(kinetic_energy(bar, v) == doctest::Approx(450.0).epsilon(1e-15));
}

TEST_CASE("the lowest frequency converges with second order to that of the continuous bar")
{
  const double exact = std::numbers::pi / 2.0; // pi c_s / (2 L_s), clamped-free, c_s = L_s = 1
  const auto error = [&](std::size_t n_elements) {
    const Bar bar{.density = 1.0, .youngs_modulus = 1.0, .length = 1.0, .n_elements = n_elements};
    return std::abs(lowest_frequency(bar) - exact) / exact;
  };
  const double e4 = error(4);
  const double e8 = error(8);
  const double e16 = error(16);

  CHECK(std::log2(e4 / e8) == doctest::Approx(2.0).epsilon(0.01)); // 2 - O(dx^2)
  CHECK(std::log2(e8 / e16) == doctest::Approx(2.0).epsilon(0.01));
  CHECK(e16 == doctest::Approx(std::pow(exact / 16.0, 2.0) / 24.0)
                   .epsilon(0.01)); // (k dx)^2 / 24, leading term
}

TEST_CASE("a free bar has a rigid-body motion")
{
  const Bar bar{.density = 1.0,
                .youngs_modulus = 1.0,
                .length = 1.0,
                .n_elements = 6,
                .far_end = FarEnd::free};
  const std::vector<double> u(7, 0.3);
  std::vector<double> f(7, 1.0);

  internal_force(bar, u, f);

  for (const double f_i : f)
    CHECK(f_i == 0.0);
  CHECK(potential_energy(bar, u) == 0.0);
}
