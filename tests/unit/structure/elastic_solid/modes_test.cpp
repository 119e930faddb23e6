// Modal analysis: frequencies of beams and arches against beam theory, and what the shapes are.
#include "elastic_solid/modes.hpp"
#include "support/solid_meshes.hpp"

#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <numbers>
#include <string>

using namespace mullion::elastic_solid;
using namespace mullion::testing;

namespace {

/// E and rho of the structure of Jaiman et al. 2011, section 6.3.
System clamped_at_ends(Solid solid, int n, Formulation formulation, Plane plane = Plane::stress)
{
  solid.material = {.youngs_modulus = 70.0e9, .poisson_ratio = 0.3, .density = 2600.0, .plane = plane};
  solid.formulation = formulation;
  return {.stiffness = stiffness_matrix(solid),
          .mass = mass_matrix(solid, MassKind::consistent),
          .free = free_dofs(solid, at_ends(n))};
}

double hertz(const Modes& modes, Eigen::Index k) { return modes.angular_frequencies[k] / (2.0 * std::numbers::pi); }

} // namespace

TEST_CASE("a straight clamped beam has the frequencies of Timoshenko's beam when its mesh is fine")
{
  // Timoshenko's theory: 85.300, 234.995, 460.323, 760.175 Hz; and the frequencies of a separate finite-element code.
  const auto modes_of = [](int n, Formulation formulation, Plane plane = Plane::stress) {
    const auto beam = mapped(n, 1, [](double s, double t) { return Eigen::Vector2d(0.5 * s, 0.004 * t); });
    return lowest_modes(clamped_at_ends(beam, n, formulation, plane), 4);
  };
  const double theory[] = {85.300, 234.995, 460.323, 760.175};
  const auto fine = modes_of(80, Formulation::enhanced);
  REQUIRE(fine.complaint == "");
  for (Eigen::Index k = 0; k < 4; ++k) {
    // The error is of second order, below (k h)^2/6 with k = (j + 1/2) pi/L, also in the table's coarse meshes.
    const double kh = (static_cast<double>(k) + 1.5) * std::numbers::pi / 80.0;
    CHECK(std::abs(hertz(fine, k) / theory[k] - 1.0) < kh * kh / 6.0);
  }

  const auto close = [](double found, double expected) { return std::abs(found - expected) < 6e-4 * 10.0; }; // 5 digits
  CHECK(close(hertz(modes_of(10, Formulation::enhanced), 0), 88.019));
  CHECK(close(hertz(modes_of(20, Formulation::enhanced), 0), 85.969));
  CHECK(close(hertz(modes_of(40, Formulation::enhanced), 0), 85.471));
  CHECK(close(hertz(fine, 0), 85.347));
  CHECK(close(hertz(modes_of(80, Formulation::enhanced, Plane::strain), 0), 89.465)); // 1/sqrt(1 - nu^2) higher
  CHECK(close(hertz(modes_of(40, Formulation::standard), 0), 188.08));                // locked: 2.2 times too high
}

TEST_CASE("clamped arches have the frequencies of Timoshenko's arch, and of another program")
{
  // length, thickness, angle in degrees; lowest two: Ritz's method for Timoshenko's arch, then a separate
  // finite-element code with 32 and 64 enhanced elements in a row.
  const struct {
    double length, thickness, degrees, theory[2], coarse[2], fine[2];
    Plane plane;
  } arches[] = {
      {.34795, .006, 15, {572.087, 723.052}, {573.411, 729.485}, {572.536, 725.031}, Plane::stress},
      {.33076, .006, 12, {519.998, 800.596}, {521.181, 807.772}, {520.399, 802.845}, Plane::stress},
      {.92437, .004, 12, {68.678, 114.417}, {69.251, 115.780}, {68.822, 114.769}, Plane::stress},
      {.3, .006, 12, {592.947, 972.091}, {594.328, 980.952}, {593.422, 974.978}, Plane::stress},
      {.3, .002, 45, {318.158, 576.358}, {320.924, 585.394}, {318.848, 578.646}, Plane::stress},
      {.5, .004, 25, {233.112, 398.572}, {235.083, 403.854}, {233.625, 399.970}, Plane::stress},
      {1.0, .006, 45, {85.915, 155.933}, {86.667, 158.396}, {86.099, 156.549}, Plane::stress},
      {1.0, .002, 45, {28.653, 52.356}, {29.001, 53.372}, {28.716, 52.564}, Plane::stress},
      {.34795, .006, 15, {599.685, 757.651}, {601.473, 764.441}, {600.354, 759.777}, Plane::strain},
  };
  for (const auto& a : arches) {
    CAPTURE(a.length);
    CAPTURE(a.degrees);
    const double angle = a.degrees * std::numbers::pi / 180.0;
    const auto modes_of = [&](int n) {
      return lowest_modes(clamped_at_ends(arch(n, 1, a.length, a.thickness, angle), n, Formulation::enhanced, a.plane),
                          2);
    };
    const auto coarse = modes_of(32), fine = modes_of(64);
    for (Eigen::Index k = 0; k < 2; ++k) {
      CHECK(std::abs(hertz(coarse, k) - a.coarse[k]) < 1e-3); // three decimals, and round-off
      CHECK(std::abs(hertz(fine, k) - a.fine[k]) < 1e-3);
      CHECK(std::abs(hertz(coarse, k) / a.theory[k] - 1.0) < (k == 0 ? 0.02 : 0.025)); // halved h: a quarter of that
      CHECK(std::abs(hertz(fine, k) / a.theory[k] - 1.0) < 0.006);
    }
  }
}

TEST_CASE("modes are normalised and orthogonal, solve the eigenproblem, and have their sign fixed")
{
  const int n = 32; // 124 free degrees of freedom: Lanczos
  const auto system = clamped_at_ends(arch(n, 1, 0.34795, 0.006, 0.2618), n, Formulation::enhanced);

  const auto modes = lowest_modes(system, 5);

  REQUIRE(modes.complaint == "");
  const Eigen::MatrixXd inertia = system.mass * modes.shapes;
  CHECK((modes.shapes.transpose() * inertia - Eigen::MatrixXd::Identity(5, 5)).cwiseAbs().maxCoeff() < 1e-10);
  for (Eigen::Index k = 0; k < 5; ++k) {
    const double squared = modes.angular_frequencies[k] * modes.angular_frequencies[k];
    const Eigen::VectorXd elastic = system.stiffness * modes.shapes.col(k);
    for (const Index i : system.free) // of terms up to the highest frequency's: 1e-10 of those
      CHECK(std::abs(elastic[i] - squared * inertia(i, k)) < 1e-7 * squared * inertia.col(k).cwiseAbs().maxCoeff());
    CHECK(modes.shapes.col(k).maxCoeff() > -0.999 * modes.shapes.col(k).minCoeff()); // positive, or equally large
    if (k > 0) CHECK(modes.angular_frequencies[k] > modes.angular_frequencies[k - 1]);
    CHECK(modes.shapes.col(k).head(2).isZero(0.0)); // node 0 is clamped
  }
  const auto again = lowest_modes(system, 5);
  CHECK((again.shapes - modes.shapes).isZero(0.0)); // to the bit

  const Eigen::VectorXd u = 3.0 * modes.shapes.col(1) - 0.5 * modes.shapes.col(4);
  const auto q = modal_coordinates(modes, system.mass, u);
  CHECK((q - (Eigen::VectorXd(5) << 0, 3, 0, 0, -0.5).finished()).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("Lanczos' method and a dense solver find the same frequencies; more modes than unknowns are refused")
{
  for (const int n : {8, 40}) { // 28 unknowns are solved whole, 156 by Lanczos
    const auto system = clamped_at_ends(arch(n, 1, 0.34795, 0.006, 0.2618), n, Formulation::enhanced);
    const auto n_free = static_cast<Eigen::Index>(system.free.size());
    const Eigen::MatrixXd k(system.stiffness), m(system.mass);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> dense(k(system.free, system.free),
                                                                          m(system.free, system.free));

    const auto modes = lowest_modes(system, 3);

    REQUIRE(modes.complaint == "");
    for (Eigen::Index i = 0; i < 3; ++i) // squared: round-off of the highest eigenvalue, 1e7 times the lowest
      CHECK(modes.angular_frequencies[i] == doctest::Approx(std::sqrt(dense.eigenvalues()[i])).epsilon(1e-8));
    CHECK(lowest_modes(system, n_free + 1).complaint.find(" free degrees of freedom; ask for fewer") !=
          std::string::npos);
  }
}

TEST_CASE("a body that nothing holds has its rigid motions at frequency 0, and then a free beam's frequency")
{
  const int n = 60;
  auto beam = mapped(n, 1, [](double s, double t) { return Eigen::Vector2d(0.5 * s, 0.004 * t); });
  beam.material = {.youngs_modulus = 70.0e9, .poisson_ratio = 0.3, .density = 2600.0};
  beam.formulation = Formulation::enhanced;
  const System system{.stiffness = stiffness_matrix(beam),
                      .mass = mass_matrix(beam, MassKind::consistent),
                      .free = free_dofs(beam, [](auto, auto) { return false; })};

  const auto modes = lowest_modes(system, 4);

  REQUIRE(modes.complaint == "");
  // A free-free beam has the clamped one's frequencies, 85.338 Hz by Euler and Bernoulli.
  for (Eigen::Index k = 0; k < 3; ++k) CHECK(hertz(modes, k) < 1e-2 * 85.3); // round-off of K against M
  CHECK(hertz(modes, 3) == doctest::Approx(85.338).epsilon(3e-3));           // shear and mesh: below 0.3 %
}
