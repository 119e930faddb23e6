// The added-mass problem as a whole: the one linear system against published numbers, and the two plug-ins' kernels
// in fixed-point iterations against the one linear system.
#include "added_mass_fluid/added_mass.hpp"
#include "string_1d/implicit_euler.hpp"

#include "support/added_mass.hpp"
#include "support/worst.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

using namespace mullion::testing;
namespace fluid = mullion::added_mass_fluid;
namespace solid = mullion::string_1d;

namespace {

using Values = std::vector<double>;

constexpr std::size_t n = 100;
constexpr double dt = 1e-4;

double norm(const Values& values)
{
  double squares = 0.0;
  for (const double v : values) squares += v * v;
  return std::sqrt(squares);
}

Values difference(const Values& a, const Values& b)
{
  Values result(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) result[i] = a[i] - b[i];
  return result;
}

/// One wall over one channel from bare kernels, coupled by a loop.
struct CoupledWall {
  explicit CoupledWall(double solid_density)
      : string{.n_points = n,
               .length = 6.0,
               .thickness = 0.1,
               .density = solid_density,
               .stiffness = 4e5,
               .tension = 2.5e4}
  {
  }

  /// The structure's answer to the pressure that a guess of its displacement makes; the pressure by the way.
  Values answer(const Values& guess, double t, Values& p) const
  {
    fluid::wall_pressure(channel, matrix, {guess, now, before}, dt, p);
    Values total = p, next(n);
    for (std::size_t i = 0; i < n; ++i)
      total[i] += solid::pulse_pressure({2e4, 5e-3}, static_cast<double>(i + 1) * string.dx(), t);
    solid::implicit_euler(string, total, now, before, dt, next);
    return next;
  }

  /// One step with Aitken's relaxation, its first factor 0.5; returns how often both solvers were called.
  int strong_step(double t)
  {
    Values x = now, p(n), p_last = p_committed, r_last;
    double omega = 0.5;
    for (int evaluation = 1; evaluation <= 200; ++evaluation) {
      const Values answered = answer(x, t, p);
      const Values r = difference(answered, x);
      if (norm(r) <= 1e-6 * norm(answered) && norm(difference(p, p_last)) <= 1e-6 * norm(p)) {
        before = now;
        now = answered;
        p_committed = p;
        return evaluation;
      }
      if (!r_last.empty()) {
        const Values change = difference(r, r_last);
        double product = 0.0;
        for (std::size_t i = 0; i < n; ++i) product += r_last[i] * change[i];
        omega *= -product / (norm(change) * norm(change));
      }
      for (std::size_t i = 0; i < n; ++i) x[i] += omega * r[i];
      r_last = r;
      p_last = p;
    }
    FAIL("no convergence in 200 iterations");
    return 0;
  }

  fluid::Channel channel{.n_points = n, .length = 6.0, .radius = 0.5, .density = 1.0};
  Values matrix = fluid::added_mass_matrix(channel);
  solid::ElasticString string;
  Values now = Values(n), before = Values(n), p_committed = Values(n);
};

} // namespace

TEST_CASE("the added mass over the mass of the wall is the one that names the case")
{
  const fluid::Channel channel{.n_points = n, .length = 6.0, .radius = 0.5, .density = 1.0};
  for (const auto& wall : added_mass_cases) {
    const double ratio = fluid::eigenvalue(channel, 1) / (0.1 * wall.solid_density);

    CHECK(std::abs(ratio - wall.mass_ratio) < 7.4e-4 * wall.mass_ratio); // given to three digits: 0.05 of 67.8
  }
}

TEST_CASE("the one linear system of string and fluid gives the displacement of a separate tool")
{
  for (const auto& wall : added_mass_cases) {
    const auto norms = monolithic_norms(wall.solid_density);

    REQUIRE(norms.size() == 51);
    CHECK(norms[0] == 0.0);
    CHECK(std::abs(norms[50] - wall.norm) < 3e-6 * wall.norm); // converged to that there
  }
}

TEST_CASE("fixed-point iterations of the kernels with Aitken's relaxation end in the coupled solution")
{
  for (const auto& wall : added_mass_cases) {
    const auto reference = monolithic_history({.solid_density = wall.solid_density});
    CoupledWall coupled(wall.solid_density);

    double error = 0.0, evaluations = 0.0;
    for (std::size_t step = 1; step <= 50; ++step) {
      evaluations += coupled.strong_step(static_cast<double>(step - 1) * dt);
      error = worst(error, norm(difference(coupled.now, reference[step])) / norm(reference[step]));
    }

    // The criterion leaves less than 1e-6 in each step, because no eigenvalue of the residual's Jacobian is below 1;
    // what earlier steps left comes on top, a few times that.
    CHECK(error < 5e-6);
    // One evaluation more or less in one step is 0.02 in the mean; the numbers are given to three digits.
    CHECK(std::abs(evaluations / 50 - wall.iterations) < 0.01 * wall.iterations);
  }
}

TEST_CASE("without relaxation the iterations grow or shrink by the ratio of the impedances in the first mode")
{
  for (const auto& wall : added_mass_cases) {
    const CoupledWall coupled(wall.solid_density);
    Values x(n), p(n);
    double last = 0.0, factor = 0.0;
    for (int k = 0; k < 8; ++k) {
      Values answered = coupled.answer(x, 0.0, p);
      const double residual = norm(difference(answered, x));
      factor = residual / last;
      last = residual;
      x.swap(answered);
    }

    const double mu = 6.0 / (std::numbers::pi * std::tanh(std::numbers::pi / 12.0)), dx = 6.0 / 101.0;
    const double half_angle = std::sin(std::numbers::pi / 202.0);
    const double impedance =
        0.1 * wall.solid_density / (dt * dt) + 4e5 + 4.0 * 2.5e4 / (dx * dx) * half_angle * half_angle;
    const double expected = mu / (dt * dt) / impedance;
    // Behind it, mu_2 / mu_1 = 0.27, the second mode is down to 0.27^14 = 1e-8 in the squares of the norm; and where
    // the residual shrinks most, by 0.0995 seven times, the round-off of x is still 1e-9 of it.
    CHECK(std::abs(factor - expected) < 1e-6 * expected);
    CHECK((factor < 1.0) == (wall.mass_ratio < 1.0));
  }
}
