// Pairs of surfaces at random: what holds of every overlay, on all of them.
#include "surface/surface_overlay.hpp"

#include "support/overlay_assembly.hpp"
#include "support/overlay_meshes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

struct Pair {
  SurfaceMesh source, target;
  bool is_flat = false; ///< both in one plane, over the same rectangle
};

/// A pair of a kind, size, orientation, place and roughness that the seed decides.
Pair random_pair(unsigned seed)
{
  std::mt19937 random(seed);
  const auto uniform = [&](double lo, double hi) {
    return lo + (hi - lo) * (static_cast<double>(random()) / 4294967296.0);
  };
  const auto number = [&](int lo, int hi) {
    return lo + static_cast<int>(random() % static_cast<unsigned>(hi - lo + 1));
  };
  Pair pair;

  const int kind = number(0, 4);
  const double gap = number(0, 1) == 0 ? 0.0 : uniform(-0.1, 0.1), stretch = std::pow(10.0, uniform(-2.0, 1.0));
  const double a = uniform(0.0, 0.1), k = uniform(0.5, 6.0);
  const auto surface = [&](double offset) -> SurfaceMap {
    if (kind == 0) return [stretch](double u, double v) { return Point(u, stretch * v, 0.0); };
    if (kind == 1) return cap(2.0 + offset);
    if (kind == 2) return wing;
    if (kind == 3) // waves over a rectangle
      return [a, k, offset, stretch](double u, double v) {
        return Point(u, stretch * v, offset + a * std::sin(k * u + 1.0) * std::cos(k * v));
      };
    return [a, k, offset](double u, double v) { // a wavy tube, closed around u but for its seam of double nodes
      const double angle = 2.0 * std::numbers::pi * u, radius = 0.5 + offset + 0.5 * a * std::cos(k * v);
      return Point(radius * std::cos(angle), radius * std::sin(angle), v);
    };
  };
  pair.is_flat = kind == 0;
  const auto mesh = [&](double offset) {
    const int least = kind == 4 ? 8 : 1;
    const auto faces = static_cast<Faces>(number(0, 2));
    // Quadrilaterals stay convex up to a shift of 1/4; triangles keep their orientation too.
    const Grid grid{number(least, 12), number(1, 12), faces, uniform(0.0, 0.24), static_cast<unsigned>(random()), 1};
    return grid_on(surface(offset), grid);
  };
  pair.source = mesh(0.0);
  pair.target = mesh(kind == 2 ? 0.0 : gap);

  const double scale = std::pow(10.0, uniform(-3.0, 3.0));
  const Point shift(uniform(-3, 3), uniform(-3, 3), uniform(-3, 3));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(uniform(0.0, 6.0), Point(uniform(-1, 1), 0.3, uniform(-1, 1)).normalized()).toRotationMatrix();
  const auto motion = [&](const Point& x) { return Point(scale * (turn * x + shift)); };
  pair.source = moved(pair.source, motion);
  pair.target = moved(pair.target, motion);
  if (number(0, 1) == 0) pair.target = turned_over(pair.target);
  if (number(0, 3) == 0) add_face(pair.target, {0, 0, 1}), add_face(pair.source, {0, 1, 0});
  return pair;
}

void check_random_pairs(unsigned first, unsigned n)
{
  int n_overlaid = 0;
  for (unsigned seed = first; seed < first + n; ++seed) {
    CAPTURE(seed);
    const auto pair = random_pair(seed);

    const auto m = assemble(pair.source, pair.target);

    n_overlaid += m.n_pieces > 0 ? 1 : 0;
    REQUIRE(m.is_ordered);
    REQUIRE(m.is_finite_and_inside);
    REQUIRE(m.source_area.allFinite());
    REQUIRE(m.report.min_coverage >= 0.0);
    REQUIRE(std::isfinite(m.report.max_coverage));
    REQUIRE(std::isfinite(m.report.largest_gap));
    REQUIRE(std::isfinite(m.report.target_covered_fraction));

    // Partition of unity: the sum over the target's nodes of what a source node gives is what the source has there.
    const Eigen::VectorXd given = m.nodal.transpose() * Eigen::VectorXd::Ones(m.nodal.rows());
    const Eigen::VectorXd had = m.source_mass * Eigen::VectorXd::Ones(m.nodal.cols());
    REQUIRE((given - had).lpNorm<Eigen::Infinity>() <= 1e-12 * had.lpNorm<Eigen::Infinity>()); // round-off

    // Area balance: covered faces, scaled, have their own area together. Those less than covered are in the report.
    double covered = 0.0;
    for (std::int32_t f = 0; f < pair.source.n_faces(); ++f)
      if (m.source_area[f] > 0.0) covered += face_measure(pair.source, f);
    REQUIRE(std::abs(m.nodal.sum() - covered) <= 1e-12 * covered);

    if (!pair.is_flat) continue;
    // Round-off of places at up to 5 sizes from the origin, in faces of 1/12 by 1/1200 of it at worst.
    REQUIRE(std::abs(m.report.min_coverage - 1.0) < 1e-9);
    REQUIRE(std::abs(m.report.max_coverage - 1.0) < 1e-9);
    for (std::int32_t t = 0; t < pair.target.n_faces(); ++t) {
      const double own = face_measure(pair.target, t);
      REQUIRE(std::abs(m.target_area[t] - own) <= 1e-9 * own);
    }
  }
  // Nothing pairs on wings of one or two faces around, which have no area, and across gaps wider than two faces.
  CHECK(n_overlaid >= static_cast<int>(0.95 * n));
}

} // namespace

TEST_CASE("random pairs of surfaces: sound pieces, a partition of unity, balanced areas")
{
  check_random_pairs(1, 300);
}

TEST_SUITE("full")
{
  TEST_CASE("many random pairs of surfaces, others each time: sound pieces, a partition of unity, balanced areas")
  {
    const unsigned first = std::random_device{}() % 1'000'000'000U;
    MESSAGE("seeds from ", first);

    check_random_pairs(first, 10'000);
  }
}
