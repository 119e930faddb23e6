// Initial states of the gas column.
#include "euler_1d/initial_states.hpp"

#include "support/kernel_storage.hpp"

#include <doctest/doctest.h>

#include <cmath>

using namespace mullion::euler_1d;
using mullion::testing::GasColumn;

namespace {

constexpr Gas air{1.4};
constexpr Reference reference{1.3, 1e5};

// The mean over [a, b] by Simpson's rule on 200 intervals, accurate to 1e-12 here.
template <class Function> double mean(Function f, double a, double b)
{
  const int n = 200;
  double sum = 0.0;
  for (int i = 0; i < n; ++i) {
    const double h = (b - a) / n;
    const double x = a + i * h;
    sum += (f(x) + 4.0 * f(x + 0.5 * h) + f(x + h)) / (6.0 * n);
  }
  return sum;
}

} // namespace

TEST_CASE("gas at rest fills equal cells with the reference state")
{
  GasColumn column(4);

  set_rest(column.state(), air, reference, 2.0);

  CHECK(column.node_x == std::vector<double>{0.0, 0.5, 1.0, 1.5, 2.0});
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(column.mass[i] == doctest::Approx(0.65).epsilon(1e-15));
    CHECK(column.momentum[i] == 0.0);
    CHECK(column.energy[i] == doctest::Approx(0.5 * 1e5 / 0.4).epsilon(1e-14));
  }
}

TEST_CASE("an acoustic mode holds the cell means of the linear solution at the asked time")
{
  const double c = std::sqrt(1.4e5 / 1.3);
  const AcousticMode mode{1e-6, 0.8 * c, 1.0};
  const double time = -4e-4;
  GasColumn column(5);

  set_acoustic_mode(column.state(), air, reference, mode, time, 1.0);

  const double omega = mode.angular_frequency;
  for (std::size_t i = 0; i < 5; ++i) {
    const double a = column.node_x[i];
    const double b = column.node_x[i + 1];
    const double dp = mean(
        [&](double x) {
          return -1.3 * c * omega * 1e-6 * std::cos(0.8 * x) / std::sin(0.8) *
                 std::cos(omega * time);
        },
        a, b);
    const double u = mean(
        [&](double x) {
          return -omega * 1e-6 * std::sin(0.8 * x) / std::sin(0.8) * std::sin(omega * time);
        },
        a, b);
    const Primitive q = cell_primitive(column.state(), air, i);
    CHECK(q.pressure - 1e5 ==
          doctest::Approx(dp).epsilon(1e-8)); // 0.1 Pa out of 1e5 Pa: 1e-9 of round-off
    CHECK(q.velocity == doctest::Approx(u).epsilon(1e-12));
    CHECK(q.density - 1.3 == doctest::Approx(dp / (c * c)).epsilon(1e-5)); // linear up to dp / p_0
  }
}

TEST_CASE("an acoustic mode keeps the mass of the undisturbed column to first order")
{
  const double c = std::sqrt(1.4e5 / 1.3);
  GasColumn column(20);

  set_acoustic_mode(column.state(), air, reference, {1e-5, 0.8 * c, 1.0}, 0.0, 1.0 + 1e-5);

  // The wall gives the gas A more room and the mode's mean density makes up for it; what is left is
  // O(A^2).
  CHECK(std::abs(totals(column.state()).mass - 1.3) < 1e-9 * 1.3);
}
