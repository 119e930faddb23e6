// Linear reconstruction in the cells.
#include "euler_1d/reconstruction.hpp"

#include <doctest/doctest.h>

#include <array>
#include <vector>

using namespace mullion::euler_1d;

TEST_CASE("both limiters reproduce linear data exactly on unequal cells")
{
  const std::vector<double> length{0.5, 1.0, 0.25, 2.0, 0.75};
  const auto linear = [](double x) { return Primitive{2.0 + x, 3.0 - 2.0 * x, 10.0 + 0.5 * x}; };
  std::vector<Primitive> cells, left(5), right(5);
  double x = 0.0;
  for (const double l : length) {
    cells.push_back(linear(x + 0.5 * l));
    x += l;
  }

  for (const Limiter limiter : {Limiter::none, Limiter::van_albada}) {
    reconstruct(cells, length, limiter, left, right);

    double face = 0.0;
    for (std::size_t i = 0; i < 5; ++i) {
      const Primitive at_left = linear(face);
      face += length[i];
      const Primitive at_right = linear(face);
      CHECK(left[i].density == doctest::Approx(at_left.density).epsilon(1e-14)); // round-off
      CHECK(left[i].velocity == doctest::Approx(at_left.velocity).epsilon(1e-14));
      CHECK(left[i].pressure == doctest::Approx(at_left.pressure).epsilon(1e-14));
      CHECK(right[i].density == doctest::Approx(at_right.density).epsilon(1e-14));
      CHECK(right[i].velocity == doctest::Approx(at_right.velocity).epsilon(1e-14));
      CHECK(right[i].pressure == doctest::Approx(at_right.pressure).epsilon(1e-14));
    }
  }
}

TEST_CASE("without limiter an inner slope is the mean of its one-sided slopes, with van Albada it "
          "is zero at extrema")
{
  const std::array<double, 3> length{1.0, 1.0, 1.0};
  const std::array<Primitive, 3> cells{Primitive{1.0, 0.0, 1.0}, {2.0, 0.0, 2.0}, {2.0, 0.0, 1.5}};
  std::array<Primitive, 3> left, right;

  reconstruct(cells, length, Limiter::none, left, right);
  CHECK(right[1].density == 2.25);   // slope (1 + 0) / 2
  CHECK(right[1].pressure == 2.125); // slope (1 - 0.5) / 2

  reconstruct(cells, length, Limiter::van_albada, left, right);
  CHECK(right[1].density == 2.0);  // one of the slopes is zero
  CHECK(right[1].pressure == 2.0); // slopes of both signs
}

TEST_CASE("van Albada's slope is a b (a + b) / (a^2 + b^2)")
{
  const std::array<double, 3> length{1.0, 1.0, 1.0};
  const std::array<Primitive, 3> cells{Primitive{1.0, 0.0, 1.0}, {2.0, 0.0, 1.0}, {5.0, 0.0, 1.0}};
  std::array<Primitive, 3> left, right;

  reconstruct(cells, length, Limiter::van_albada, left, right);

  CHECK(right[1].density == doctest::Approx(2.0 + 0.5 * 3.0 * 4.0 / 10.0).epsilon(1e-15));
}

TEST_CASE("an end value on equal cells is 1.5 of the end cell less 0.5 of its neighbour")
{
  const Primitive value = end_value({2.0, 6.0, 4.0}, 0.1, {1.0, 8.0, 4.0}, 0.1);

  CHECK(value.density == 2.5);
  CHECK(value.velocity == 5.0);
  CHECK(value.pressure == 4.0);
}

TEST_CASE("a single cell is reconstructed as constant")
{
  const std::array<double, 1> length{1.0};
  const std::array<Primitive, 1> cells{Primitive{1.0, 2.0, 3.0}};
  std::array<Primitive, 1> left, right;

  reconstruct(cells, length, Limiter::none, left, right);

  CHECK(left[0].velocity == 2.0);
  CHECK(right[0].pressure == 3.0);
}
