// Which polynomials the rules integrate exactly.
#include "surface/quadrature_rules.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::surface;

namespace {

double integral(const Rule& rule, int i, int j)
{
  double sum = 0.0;
  for (const auto& p : rule) sum += p.weight * std::pow(p.xi[0], i) * std::pow(p.xi[1], j);
  return sum;
}

/// integral of xi^i eta^j over the reference triangle: i! j! / (i + j + 2)!
double exact_on_triangle(int i, int j) { return std::tgamma(i + 1) * std::tgamma(j + 1) / std::tgamma(i + j + 3); }

void check_triangle(const Rule& rule, int degree)
{
  for (int i = 0; i <= degree; ++i)
    for (int j = 0; i + j <= degree; ++j) {
      CAPTURE(i);
      CAPTURE(j);
      CHECK(integral(rule, i, j) == doctest::Approx(exact_on_triangle(i, j)).epsilon(1e-13)); // sums of few numbers
    }
}

} // namespace

TEST_CASE("n Gauss points are exact to degree 2 n - 1 and not beyond")
{
  for (const int n : {1, 2, 3, 4, 5, 8, 16, 31, 64}) {
    const auto rule = gauss_rule(n);
    CAPTURE(n);
    CHECK(rule.size() == static_cast<std::size_t>(n));
    for (int degree = 0; degree <= 2 * n - 1; ++degree)
      CHECK(integral(rule, degree, 0) == doctest::Approx(1.0 / (degree + 1)).epsilon(1e-12)); // 64 terms of 1e-15
    for (std::size_t i = 1; i < rule.size(); ++i) CHECK(rule[i - 1].xi[0] < rule[i].xi[0]);
    if (n <= 4)
      CHECK(std::abs(integral(rule, 2 * n, 0) - 1.0 / (2 * n + 1)) > 1e-7); // (n!)^4 / ((2n+1) (2n)!^2): 2.3e-5 at 4
  }
}

TEST_CASE("two Gauss points are those of every textbook")
{
  const auto rule = gauss_rule(2);

  CHECK(rule[0].xi[0] == doctest::Approx(0.21132486540518708).epsilon(1e-15)); // (1 - 1/sqrt(3)) / 2
  CHECK(rule[1].xi[0] == doctest::Approx(0.78867513459481287).epsilon(1e-15));
  CHECK(rule[0].weight == doctest::Approx(0.5).epsilon(1e-15));
}

TEST_CASE("rules on triangles are exact to the degree that they claim")
{
  check_triangle(face_rule(3, 1), 1);
  check_triangle(face_rule(3, 2), 2);
  for (const int n : {3, 5, 8}) check_triangle(face_rule(3, n), 2 * n - 2);
  check_triangle(triangle_rule_of_degree_4(), 4);
  CHECK(std::abs(integral(triangle_rule_of_degree_4(), 5, 0) - exact_on_triangle(5, 0)) > 1e-6);
}

TEST_CASE("rules on quadrilaterals are exact in each direction")
{
  const auto rule = face_rule(4, 2);

  for (int i = 0; i <= 3; ++i)
    for (int j = 0; j <= 3; ++j)
      CHECK(integral(rule, i, j) == doctest::Approx(1.0 / ((i + 1) * (j + 1))).epsilon(1e-14));
}
