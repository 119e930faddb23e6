// Time integration: energy, periods, given motions, the explicit method's limit, a wave in a strip.
#include "elastic_solid/boundary.hpp"
#include "elastic_solid/modes.hpp"
#include "elastic_solid/time_integration.hpp"
#include "support/solid_meshes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace mullion::elastic_solid;
using namespace mullion::testing;

namespace {

/// A short, thick cantilever of 6 x 2 elements, of unit size.
struct Cantilever {
  System system;
  Eigen::VectorXd u, v, a, load;
  Given held;

  explicit Cantilever(MassKind kind = MassKind::consistent)
  {
    auto solid = mapped(6, 2, [](double s, double t) { return Eigen::Vector2d(3.0 * s, t + 0.1 * s * t); });
    solid.material = {.youngs_modulus = 100.0, .poisson_ratio = 0.3, .density = 1.0};
    solid.formulation = Formulation::enhanced;
    system = {.stiffness = stiffness_matrix(solid),
              .mass = mass_matrix(solid, kind),
              .free = free_dofs(solid, [](auto node, auto) { return node % 7 == 0; })};
    const auto n = solid.n_dofs();
    u = v = a = load = Eigen::VectorXd::Zero(n);
    held = {Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (const Index i : system.free) load[i] = std::sin(0.7 * static_cast<double>(i));
  }
  Motion motion() { return {u, v, a}; }
  [[nodiscard]] double energy() const
  {
    return mullion::elastic_solid::energy(system.mass, v) + mullion::elastic_solid::energy(system.stiffness, u);
  }
};

/// One mass of 1 kg on a spring, as a system of one degree of freedom.
System oscillator(double omega)
{
  SparseMatrix k(1, 1), m(1, 1);
  k.insert(0, 0) = omega * omega;
  m.insert(0, 0) = 1.0;
  return {.stiffness = k, .mass = m, .free = {0}};
}

/// Angular frequency of a run: from the phase after many steps.
template <class Step> double measured_frequency(double omega, double dt, int n_steps, const Step& step)
{
  Eigen::VectorXd u = Eigen::VectorXd::Ones(1), v = Eigen::VectorXd::Zero(1), a = -omega * omega * u;
  double angle = 0.0, before = 0.0;
  for (int n = 0; n < n_steps; ++n) {
    step(Motion{u, v, a});
    const double now = std::atan2(-v[0] / omega, u[0]);
    angle += std::remainder(now - before, 2.0 * std::numbers::pi);
    before = now;
  }
  return angle / (n_steps * dt);
}

const Given nothing_given{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};
const Eigen::VectorXd no_load = Eigen::VectorXd::Zero(1);

} // namespace

TEST_CASE("Newmark's step changes the energy by the work of the mean load, to round-off")
{
  Cantilever body;
  const FreeSolver mass(body.system.mass, body.system.free);
  balance_acceleration(body.system, mass, body.motion(), body.load);
  const Newmark newmark(body.system, {}, 0.05);
  Eigen::VectorXd before = body.load;
  double scale = 0.0, worst = 0.0;
  for (int n = 1; n <= 200; ++n) {
    const Eigen::VectorXd after = std::cos(0.3 * n) * body.load, u = body.u;
    const double energy = body.energy();
    newmark.step(body.system, body.motion(), before, after, body.held);
    const double work = 0.5 * (before + after).dot(body.u - u);
    scale = std::max(scale, body.energy());
    worst = std::max(worst, std::abs(body.energy() - energy - work));
    before = after;
  }
  CHECK(scale > 0.1);           // it moves
  CHECK(worst < 1e-12 * scale); // round-off of some 40 degrees of freedom
}

TEST_CASE("a load that is constant over a step does its work too, once the acceleration follows its jump")
{
  Cantilever body;
  const FreeSolver mass(body.system.mass, body.system.free);
  const Newmark newmark(body.system, {}, 0.05);
  double scale = 0.0, worst = 0.0;
  for (int n = 1; n <= 200; ++n) {
    const Eigen::VectorXd load = std::cos(0.3 * n) * body.load, u = body.u;
    const double energy = body.energy();
    balance_acceleration(body.system, mass, body.motion(), load);
    newmark.step(body.system, body.motion(), load, load, body.held);
    scale = std::max(scale, body.energy());
    worst = std::max(worst, std::abs(body.energy() - energy - load.dot(body.u - u)));
    // The acceleration is in balance with that load: no ringing from step to step.
    const Eigen::VectorXd rest = load - body.system.stiffness * body.u - body.system.mass * body.a;
    for (const Index i : body.system.free) CHECK(std::abs(rest[i]) < 1e-10);
  }
  CHECK(worst < 1e-12 * scale);
}

TEST_CASE("Newmark's period is longer by (omega dt)^2/12, and so numerical_frequency says, for every integrator")
{
  const double omega = 3.0, dt = 0.02; // omega dt = 0.06
  const auto system = oscillator(omega);
  const FreeSolver mass(system.mass, system.free);
  const int n = 20000;

  const Newmark newmark(system, {}, dt);
  const double average =
      measured_frequency(omega, dt, n, [&](Motion m) { newmark.step(system, m, no_load, no_load, nothing_given); });
  const double x = omega * dt;
  CHECK(omega / average == doctest::Approx(1.0 + x * x / 12.0).epsilon(1e-6)); // next term: x^4/80 = 1.6e-7

  const double explicit_one = measured_frequency(
      omega, dt, n, [&](Motion m) { central_difference_step(system, mass, m, dt, no_load, nothing_given); });
  CHECK(omega / explicit_one == doctest::Approx(1.0 - x * x / 24.0).epsilon(1e-6));

  // The angle after n steps is measured up to a fraction x^2 of a radian: 1e-6 relative after 1200 radians.
  CHECK(numerical_frequency(omega, dt, {}) == doctest::Approx(average).epsilon(4e-6));
  CHECK(numerical_frequency(omega, dt, {.beta = 0.0}) == doctest::Approx(explicit_one).epsilon(4e-6));
  for (const double rho : {1.0, 0.8, 0.3}) {
    const auto p = generalised_alpha(rho);
    const Newmark alpha(system, p, dt);
    const double found =
        measured_frequency(omega, dt, 2000, [&](Motion m) { alpha.step(system, m, no_load, no_load, nothing_given); });
    CHECK(numerical_frequency(omega, dt, p) == doctest::Approx(found).epsilon(4e-5)); // 120 radians
    CHECK(std::abs(found / omega - 1.0) < x * x);                                     // second order
  }
  CHECK(numerical_frequency(omega, 1.0, {.beta = 0.0}) == doctest::Approx(std::numbers::pi)); // beyond its limit
}

TEST_CASE("generalised alpha is of second order and leaves rho_inf of the highest frequency in each step")
{
  for (const double rho : {1.0, 0.6, 0.0}) {
    CAPTURE(rho);
    const auto p = generalised_alpha(rho);
    double before = 0.0;
    for (const int n : {200, 400}) { // u'' + 4 u = sin t, u = sin(t)/3 from v = 1/3, for 5 s
      const double dt = 5.0 / n;
      const auto system = oscillator(2.0);
      const Newmark alpha(system, p, dt);
      Eigen::VectorXd u = Eigen::VectorXd::Zero(1), v = Eigen::VectorXd::Constant(1, 1.0 / 3.0), a = u;
      double error = 0.0;
      for (int k = 0; k < n; ++k) {
        alpha.step(system, {u, v, a}, Eigen::VectorXd::Constant(1, std::sin(k * dt)),
                   Eigen::VectorXd::Constant(1, std::sin((k + 1) * dt)), nothing_given);
        error = std::max(error, std::abs(u[0] - std::sin((k + 1) * dt) / 3.0));
      }
      if (before > 0.0) CHECK(std::log2(before / error) == doctest::Approx(2.0).epsilon(0.05)); // next order's share
      before = error;
    }
    const auto stiff = oscillator(1e6); // omega dt = 1e6
    const Newmark alpha(stiff, p, 1.0);
    Eigen::VectorXd u = Eigen::VectorXd::Ones(1), v = Eigen::VectorXd::Zero(1), a = -1e12 * u;
    double largest = 0.0;
    const int n_steps = 40;
    for (int k = 0; k < n_steps; ++k) alpha.step(stiff, {u, v, a}, no_load, no_load, nothing_given);
    largest = std::abs(u[0]);
    // A triple eigenvalue: rho^n times a polynomial of degree 2 in n at most.
    CHECK(largest <= 2.0 * n_steps * n_steps * std::pow(rho, n_steps) + 1e-6);
  }
}

TEST_CASE("Rayleigh's damping takes the amplitude down by (a_0/omega + a_1 omega)/2 a radian")
{
  auto system = oscillator(3.0);
  system.rayleigh_mass = 0.06;
  system.rayleigh_stiffness = 0.004;
  const double ratio = 0.5 * (0.06 / 3.0 + 0.004 * 3.0), dt = 0.002;
  const FreeSolver mass(system.mass, system.free);
  for (const bool is_explicit : {false, true}) {
    Eigen::VectorXd u = Eigen::VectorXd::Ones(1), v = Eigen::VectorXd::Zero(1), a = -9.0 * u;
    const Newmark newmark(system, {}, dt);
    double amplitude = 1.0;
    for (int n = 0; n < 10000; ++n) {
      if (is_explicit) central_difference_step(system, mass, {u, v, a}, dt, no_load, nothing_given);
      else newmark.step(system, {u, v, a}, no_load, no_load, nothing_given);
      amplitude = std::hypot(u[0], v[0] / 3.0);
    }
    // The amplitude wavers by the ratio 0.016 within a period; the explicit one takes the velocity half a step late.
    CHECK(std::log(amplitude) == doctest::Approx(-ratio * 3.0 * 20.0).epsilon(0.03));
  }
}

TEST_CASE("central differences are stable just below 2/omega_max and not above")
{
  for (const auto kind : {MassKind::lumped, MassKind::consistent}) {
    Cantilever body(kind);
    const FreeSolver mass(body.system.mass, body.system.free);

    const double omega = highest_frequency(body.system, mass);

    const auto n_free = static_cast<Eigen::Index>(body.system.free.size());
    const auto all = lowest_modes(body.system, n_free);                                 // solved whole
    CHECK(omega == doctest::Approx(all.angular_frequencies[n_free - 1]).epsilon(1e-5)); // where power iteration stops
    for (const double factor : {0.999, 1.01}) {
      body.u = body.load / body.load.norm();
      body.v.setZero();
      body.a.setZero();
      balance_acceleration(body.system, mass, body.motion(), 0.0 * body.load);
      const double start = body.energy();
      for (int n = 0; n < 1000; ++n)
        central_difference_step(body.system, mass, body.motion(), factor * 2.0 / omega, 0.0 * body.load, body.held);
      if (factor < 1.0) CHECK(body.energy() < 1e4 * start); // swings, by 1/(1 - factor^2), and stays
      else CHECK(!(body.energy() < 1e30 * start));          // grows by some 30 % a step
    }
  }
}

TEST_CASE("a body whose support is moved as a rigid whole follows it")
{
  // Translation of the clamped end with constant acceleration: with the right inertia forces the body, loaded by M g,
  // stays undeformed.
  for (const bool is_explicit : {false, true})
    for (const auto kind : {MassKind::lumped, MassKind::consistent}) {
      Cantilever body(kind);
      const FreeSolver mass(body.system.mass, body.system.free);
      const double g = 0.8, dt = is_explicit ? 0.005 : 0.05;
      Eigen::VectorXd all_x = Eigen::VectorXd::Zero(body.u.size());
      for (Eigen::Index i = 0; i < all_x.size(); i += 2) all_x[i] = 1.0;
      const Eigen::VectorXd load = g * (body.system.mass * all_x);
      const Newmark newmark(body.system, {}, dt);
      body.a = g * all_x;
      for (int n = 1; n <= 40; ++n) {
        const double t = n * dt;
        const Given given{0.5 * g * t * t * all_x, g * t * all_x, g * all_x};
        if (is_explicit) central_difference_step(body.system, mass, body.motion(), dt, load, given);
        else newmark.step(body.system, body.motion(), load, load, given);
      }
      const double t = 40 * dt;
      CHECK((body.u - 0.5 * g * t * t * all_x).cwiseAbs().maxCoeff() < 1e-11); // round-off of 100 * 1e-16 * 40 steps
      CHECK((body.a - g * all_x).cwiseAbs().maxCoeff() < 1e-9);
    }
}

TEST_CASE("a pressure step runs down a strip as the exact plane wave")
{
  // Rollers at the sides: a strip of plane stress with modulus E/(1 - nu^2). A traction P along +x on the end x = 0
  // from t = 0 on: u = P/(rho c) (t - x/c) for x < c t.
  const int n = 100;
  auto strip = mapped(n, 1, [](double s, double t) { return Eigen::Vector2d(s, 0.01 * t); });
  strip.material = {.youngs_modulus = 2.0, .poisson_ratio = 0.3, .density = 1.0};
  const double c = std::sqrt(2.0 / 0.91), pressure = 1.0, end = 0.6 / c;
  for (const bool is_explicit : {true, false}) {
    const auto kind = is_explicit ? MassKind::lumped : MassKind::consistent;
    const System system{.stiffness = stiffness_matrix(strip),
                        .mass = mass_matrix(strip, kind),
                        .free = free_dofs(strip, [](auto, auto k) { return k == 1; })};
    const FreeSolver mass(system.mass, system.free);
    const auto edge = surface_mass(strip.nodes, surface_of(strip, {{0, 3}}));
    Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(2, strip.n_nodes());
    loads.row(0) = Eigen::RowVectorXd::Constant(strip.n_nodes(), pressure) * edge;
    const Eigen::VectorXd load = loads.reshaped(), zero = Eigen::VectorXd::Zero(load.size());
    Eigen::VectorXd u = zero, v = zero, a = zero;
    balance_acceleration(system, mass, {u, v, a}, load);
    const int n_steps = 75;
    const double dt = end / n_steps; // c dt/dx = 0.8
    const Newmark newmark(system, {}, dt);
    for (int k = 0; k < n_steps; ++k) {
      if (is_explicit) central_difference_step(system, mass, {u, v, a}, dt, load, {zero, zero, zero});
      else newmark.step(system, {u, v, a}, load, load, {zero, zero, zero});
    }
    double worst = 0.0;
    for (Eigen::Index i = 0; i <= n; ++i) {
      const double exact = pressure / c * std::max(0.0, end - strip.nodes(0, i) / c);
      worst = std::max(worst, std::abs(u[2 * i] - exact));
    }
    const double largest = pressure / c * end;
    CHECK(u[0] == doctest::Approx(largest).epsilon(0.01)); // the loaded end, far behind the front: ringing of a cell
    CHECK(worst < 0.02 * largest); // the front is smeared over dx (t c/dx)^(1/3) = 4 cells of the 60, the kink by some
  }
}
