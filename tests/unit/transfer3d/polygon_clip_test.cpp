// Convex polygons cut by lines.
#include "surface/polygon_clip.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>
#include <random>

using namespace mullion::surface;

namespace {

/// Carries its own place as (xi, eta), twice, so that what is carried can be compared with what it should be.
ClipPolygon polygon(std::initializer_list<PlanePoint> corners)
{
  ClipPolygon p;
  p.n = 0;
  for (const auto& [x, y] : corners) p.vertices[static_cast<std::size_t>(p.n++)] = {x, y, 2.0 * x, 2.0 * y, x + y};
  return p;
}

const auto unit_square = polygon({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}});

} // namespace

TEST_CASE("a cut through a square leaves the half that is left of the line")
{
  ClipPolygon p = unit_square;

  clip(p, left_of({0.5, 0.0}, {0.5, 1.0}));

  CHECK(p.n == 4);
  CHECK(signed_area(p) == 0.5);
  for (int k = 0; k < p.n; ++k) CHECK(p.vertices[static_cast<std::size_t>(k)].x <= 0.5);
}

TEST_CASE("a line along an edge cuts nothing off from the inside and all but the edge from the outside")
{
  ClipPolygon inside = unit_square, outside = unit_square;

  clip(inside, left_of({0.0, 0.0}, {1.0, 0.0}));
  clip(outside, left_of({1.0, 0.0}, {0.0, 0.0}));

  CHECK(inside.n == 4);
  CHECK(signed_area(inside) == 1.0);
  CHECK(signed_area(outside) == 0.0);
}

TEST_CASE("a polygon beyond the line is gone")
{
  ClipPolygon p = unit_square;

  clip(p, left_of({2.0, 1.0}, {2.0, 0.0}));

  CHECK(p.n == 0);
  CHECK(signed_area(p) == 0.0);
}

TEST_CASE("a square cut by a turned square is an octagon")
{
  // The corners of side 1 lie at distance 1/sqrt(2) from the middle; the turned square's sides at distance 0.6 cut
  // triangles of height 1/sqrt(2) - 0.6 off, each of area height^2.
  ClipPolygon p = unit_square;
  const double r = 0.6 * std::sqrt(2.0);

  clip(p, left_of({0.5 + r, 0.5}, {0.5, 0.5 + r}));
  clip(p, left_of({0.5, 0.5 + r}, {0.5 - r, 0.5}));
  clip(p, left_of({0.5 - r, 0.5}, {0.5, 0.5 - r}));
  clip(p, left_of({0.5, 0.5 - r}, {0.5 + r, 0.5}));

  CHECK(p.n == 8);
  const double height = 1.0 / std::sqrt(2.0) - 0.6;
  CHECK(signed_area(p) == doctest::Approx(1.0 - 4.0 * height * height).epsilon(1e-14)); // round-off
}

TEST_CASE("what a polygon carries is linear between its corners after any number of cuts")
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-1.0, 2.0);
  int n_left = 0;
  for (int trial = 0; trial < 200; ++trial) {
    ClipPolygon p = unit_square;
    for (int cut = 0; cut < 4; ++cut) clip(p, left_of({place(random), place(random)}, {place(random), place(random)}));
    for (int k = 0; k < p.n; ++k) {
      const auto& v = p.vertices[static_cast<std::size_t>(k)];
      CHECK(std::abs(v.xi - 2.0 * v.x) < 1e-14); // round-off of four interpolations
      CHECK(std::abs(v.eta - 2.0 * v.y) < 1e-14);
      CHECK(std::abs(v.gap - v.x - v.y) < 1e-14);
      ++n_left;
    }
  }
  CHECK(n_left > 100);
}

TEST_CASE("both sides of a cut add up to the polygon")
{
  std::mt19937 random(6);
  std::uniform_real_distribution<double> place(-0.5, 1.5);
  for (int trial = 0; trial < 200; ++trial) {
    const PlanePoint a{place(random), place(random)}, b{place(random), place(random)};
    ClipPolygon left = unit_square, right = unit_square;

    clip(left, left_of(a, b));
    clip(right, left_of(b, a));

    CHECK(signed_area(left) + signed_area(right) == doctest::Approx(1.0).epsilon(1e-14)); // round-off
  }
}

TEST_CASE("two polygons that share an edge get the same bits where it is cut")
{
  const PlanePoint a{0.1, 0.2}, b{0.7, 0.9};
  ClipPolygon right = polygon({a, {0.9, 0.1}, b}), left = polygon({b, {0.0, 1.0}, a});
  const auto side = left_of({0.0, 0.61}, {1.0, 0.57});

  clip(right, side);
  clip(left, side);

  int n_same = 0;
  for (int i = 0; i < right.n; ++i)
    for (int j = 0; j < left.n; ++j) {
      const auto &p = right.vertices[static_cast<std::size_t>(i)], &q = left.vertices[static_cast<std::size_t>(j)];
      n_same += p.x == q.x && p.y == q.y ? 1 : 0;
    }
  CHECK(n_same == 2); // b and the cut
}

TEST_CASE("neighbouring vertices closer than the tolerance are merged, also around the end")
{
  ClipPolygon p = polygon({{0.0, 0.0}, {1.0, 0.0}, {1.0, 1e-15}, {1.0, 1.0}, {0.0, 1.0}, {1e-15, 0.0}});

  simplify(p, 1e-14, 8);

  CHECK(p.n == 4);
  CHECK(signed_area(p) == doctest::Approx(1.0).epsilon(1e-14));
}

TEST_CASE("too many vertices lose the flattest corners first")
{
  ClipPolygon p = polygon({{0.0, 0.0}, {0.5, -1e-13}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}});

  simplify(p, 0.0, 4);

  CHECK(p.n == 4);
  CHECK(signed_area(p) == 1.0); // what is left are the corners of the square
}

TEST_CASE("the inverse of the bilinear map gives back the local coordinates")
{
  // A square, a trapezium, a general quadrilateral, one with a corner of almost 180 degrees, a thin one.
  const PlaneCorners shapes[] = {{{{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}},
                                 {{{0.0, 0.0}, {2.0, 0.0}, {1.2, 1.0}, {0.7, 1.0}}},
                                 {{{-3.0, 1.0}, {0.5, -0.7}, {1.4, 0.9}, {-1.0, 2.5}}},
                                 {{{0.0, 0.0}, {1.0, 0.0}, {0.501, 0.501}, {0.0, 1.0}}},
                                 {{{0.0, 0.0}, {1.0, 1e-6}, {1.1, 3e-6}, {0.0, 1e-6}}}};
  for (const auto& c : shapes) {
    REQUIRE(is_convex(c));
    for (double xi = 0.0; xi <= 1.0; xi += 0.125)
      for (double eta = 0.0; eta <= 1.0; eta += 0.125) {
        PlanePoint p{};
        for (std::size_t i = 0; i < 2; ++i)
          p[i] =
              (1 - xi) * (1 - eta) * c[0][i] + xi * (1 - eta) * c[1][i] + xi * eta * c[2][i] + (1 - xi) * eta * c[3][i];

        const auto found = inverse_bilinear(c, p);

        // Round-off over the least Jacobian of these shapes, relative to their sizes: 2e-3.
        CHECK(std::abs(found[0] - xi) < 1e-12);
        CHECK(std::abs(found[1] - eta) < 1e-12);
      }
  }
}

TEST_CASE("a quadrilateral without area has local coordinates, if no unique ones")
{
  const PlaneCorners point = {{{1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}, {1.0, 1.0}}};

  const auto found = inverse_bilinear(point, {1.0, 1.0});

  CHECK(found[0] >= 0.0);
  CHECK(found[0] <= 1.0);
  CHECK(found[1] >= 0.0);
  CHECK(found[1] <= 1.0);
}

TEST_CASE("the diagonal that lies inside starts at the corner that points inwards")
{
  CHECK(is_cut_from_1_to_3({{{0.0, 0.0}, {0.4, 0.4}, {1.0, 1.0}, {0.0, 1.0}}}) == false); // straight at corner 1
  CHECK(is_cut_from_1_to_3({{{0.0, 0.0}, {0.3, 0.4}, {1.0, 1.0}, {0.0, 1.0}}}) == true);
  CHECK(is_cut_from_1_to_3({{{0.6, 0.6}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}}) == false);
}
