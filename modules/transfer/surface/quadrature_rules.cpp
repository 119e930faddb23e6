#include "quadrature_rules.hpp"

#include <cmath>
#include <numbers>

namespace mullion::surface {

Rule gauss_rule(int n)
{
  Rule rule(static_cast<std::size_t>(n));
  for (int i = 0; i < (n + 1) / 2; ++i) {
    // Root of the Legendre polynomial P_n, counted from +1; Newton from Tricomi's estimate, which is close enough that
    // no root is found twice.
    double x = std::cos(std::numbers::pi * (i + 0.75) / (n + 0.5));
    double slope = 1.0;
    for (int iteration = 0; iteration < 20; ++iteration) {
      double p = x, before = 1.0; // P_1, P_0
      for (int k = 2; k <= n; ++k) {
        const double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n == 1 ? 1.0 : n * (x * p - before) / (x * x - 1.0);
      const double step = p / slope;
      x -= step;
      if (std::abs(step) < 1e-16) break;
    }
    if (2 * i + 1 == n) x = 0.0;
    const double weight = 1.0 / ((1.0 - x * x) * slope * slope); // for [0, 1]; half of that for [-1, 1]
    const auto low = static_cast<std::size_t>(i), high = static_cast<std::size_t>(n - 1 - i);
    rule[low] = {{0.5 - 0.5 * x, 0.0}, weight};
    rule[high] = {{0.5 + 0.5 * x, 0.0}, weight};
  }
  return rule;
}

Rule face_rule(std::size_t n_nodes, int n)
{
  const Rule line = gauss_rule(n);
  if (n_nodes == 2) return line;
  if (n_nodes == 3 && n == 1) return {{{1.0 / 3.0, 1.0 / 3.0}, 0.5}};
  if (n_nodes == 3 && n == 2)
    return {
        {{1.0 / 6.0, 1.0 / 6.0}, 1.0 / 6.0}, {{2.0 / 3.0, 1.0 / 6.0}, 1.0 / 6.0}, {{1.0 / 6.0, 2.0 / 3.0}, 1.0 / 6.0}};
  Rule rule;
  for (const auto& b : line)
    for (const auto& a : line) {
      if (n_nodes == 3) rule.push_back({{a.xi[0] * (1.0 - b.xi[0]), b.xi[0]}, a.weight * b.weight * (1.0 - b.xi[0])});
      else rule.push_back({{a.xi[0], b.xi[0]}, a.weight * b.weight});
    }
  return rule;
}

const Rule& mass_rule(std::size_t n_nodes)
{
  static const Rule line = face_rule(2, 2), triangle = face_rule(3, 2), quadrilateral = face_rule(4, 2);
  return n_nodes == 2 ? line : n_nodes == 3 ? triangle : quadrilateral;
}

Rule triangle_rule_of_degree_4()
{
  // Two orbits of three points (1 - 2 a, a, a); a and the weights solve the moment equations up to degree 4.
  const double root = std::sqrt(10.0), other = std::sqrt(38.0 - 44.0 * std::sqrt(0.4));
  Rule rule;
  for (const double sign : {1.0, -1.0}) {
    const double a = (8.0 - root + sign * other) / 18.0;
    const double weight = (620.0 + sign * std::sqrt(213125.0 - 53320.0 * root)) / 7440.0;
    rule.push_back({{a, a}, weight});
    rule.push_back({{1.0 - 2.0 * a, a}, weight});
    rule.push_back({{a, 1.0 - 2.0 * a}, weight});
  }
  return rule;
}

} // namespace mullion::surface
