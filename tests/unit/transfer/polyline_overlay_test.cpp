// The pieces of overlays that can be checked by hand, and outlines that are awkward: corners that do not quite agree,
// two bodies, parts of loops, branches, faces without length, plates that are thinner than their faces.
#include "surface/polyline_overlay.hpp"

#include "support/surface_pairs.hpp"
#include "support/worst.hpp"
#include "surface/aabb_tree.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>
#include <vector>

using namespace mullion::surface;
using namespace mullion::testing;

namespace {

using Outline = std::vector<Eigen::Vector2d>;

/// Each side of a polygon cut into n[i] equal faces.
SurfaceMesh polygon(const Outline& corners, const std::vector<int>& n)
{
  Outline x;
  for (std::size_t k = 0; k < corners.size(); ++k)
    for (int i = 0; i < n[k]; ++i)
      x.push_back(corners[k] + static_cast<double>(i) / n[k] * (corners[(k + 1) % corners.size()] - corners[k]));
  return polyline(x, true);
}

/// Two meshes in one, with the nodes and faces of the second after those of the first.
SurfaceMesh both(const SurfaceMesh& a, const SurfaceMesh& b)
{
  SurfaceMesh mesh = a;
  mesh.nodes.resize(2, a.n_nodes() + b.n_nodes());
  mesh.nodes << a.nodes, b.nodes;
  for (const auto node : b.face_nodes) mesh.face_nodes.push_back(node + static_cast<std::int32_t>(a.n_nodes()));
  mesh.face_begin.clear();
  for (std::int32_t begin = 0; begin <= static_cast<std::int32_t>(mesh.face_nodes.size()); begin += 2)
    mesh.face_begin.push_back(begin);
  return mesh;
}

/// Pieces are grouped and sorted as promised, lie in their faces, and cover each source face once.
void check_pieces(const SurfaceMesh& source, const SurfaceMesh& target, const std::vector<Subelement>& pieces)
{
  std::vector<double> covered(static_cast<std::size_t>(source.n_faces()), 0.0);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const auto& p = pieces[i];
    REQUIRE(p.n_vertices == 2);
    REQUIRE((p.source_face >= 0 && p.source_face < source.n_faces()));
    REQUIRE((p.target_face >= 0 && p.target_face < target.n_faces()));
    if (i > 0)
      CHECK(std::tuple(pieces[i - 1].source_face, pieces[i - 1].target_face) <=
            std::tuple(p.source_face, p.target_face));
    for (int k = 0; k < 2; ++k) {
      CHECK((p.source_xi[k][0] >= 0.0 && p.source_xi[k][0] <= 1.0));
      CHECK((p.target_xi[k][0] >= 0.0 && p.target_xi[k][0] <= 1.0));
    }
    CHECK(p.source_xi[1][0] >= p.source_xi[0][0]);
    covered[static_cast<std::size_t>(p.source_face)] += p.source_xi[1][0] - p.source_xi[0][0];
  }
  const auto skipped = degenerate_faces(source);
  for (std::size_t f = 0; f < covered.size(); ++f)
    if (std::find(skipped.begin(), skipped.end(), static_cast<std::int32_t>(f)) == skipped.end())
      CHECK(covered[f] == doctest::Approx(1.0).epsilon(1e-12)); // sums of differences of numbers of order one
}

void check_piece(const Subelement& p, int source, double s0, double s1, int target, double t0, double t1)
{
  CHECK(p.source_face == source);
  CHECK(p.target_face == target);
  CHECK(p.source_xi[0][0] == doctest::Approx(s0).epsilon(1e-14));
  CHECK(p.source_xi[1][0] == doctest::Approx(s1).epsilon(1e-14));
  CHECK(p.target_xi[0][0] == doctest::Approx(t0).epsilon(1e-14));
  CHECK(p.target_xi[1][0] == doctest::Approx(t1).epsilon(1e-14));
}

} // namespace

TEST_CASE("two faces over three make four pieces")
{
  const auto [pieces, report] = overlay(along(flat, 2), along(flat, 3));

  REQUIRE(pieces.size() == 4);
  check_piece(pieces[0], 0, 0.0, 2.0 / 3.0, 0, 0.0, 1.0);
  check_piece(pieces[1], 0, 2.0 / 3.0, 1.0, 1, 0.0, 0.5);
  check_piece(pieces[2], 1, 0.0, 1.0 / 3.0, 1, 0.5, 1.0);
  check_piece(pieces[3], 1, 1.0 / 3.0, 1.0, 2, 0.0, 1.0);
  CHECK(report.covered_fraction == 1.0);
  CHECK(report.target_covered_fraction == doctest::Approx(1.0).epsilon(1e-15));
  CHECK_FALSE(report.is_opposite);
}

TEST_CASE("a target that runs the other way gives the same pieces with its coordinates turned")
{
  const auto [pieces, report] = overlay(along(flat, 2), reversed(along(flat, 3)));

  REQUIRE(pieces.size() == 4);
  check_piece(pieces[0], 0, 2.0 / 3.0, 1.0, 1, 1.0, 0.5);
  check_piece(pieces[1], 0, 0.0, 2.0 / 3.0, 2, 1.0, 0.0);
  check_piece(pieces[2], 1, 1.0 / 3.0, 1.0, 0, 1.0, 0.0);
  check_piece(pieces[3], 1, 0.0, 1.0 / 3.0, 1, 0.5, 0.0);
  CHECK(report.is_opposite);
}

TEST_CASE("identical meshes make one piece a face")
{
  for (const auto& mesh : {along(arc, 17), polygon({{0, 0}, {2, 0}, {2, 1}, {0, 1}}, {4, 3, 4, 3})}) {
    const auto [pieces, report] = overlay(mesh, mesh);

    REQUIRE(pieces.size() == static_cast<std::size_t>(mesh.n_faces()));
    for (std::size_t f = 0; f < pieces.size(); ++f)
      check_piece(pieces[f], static_cast<int>(f), 0.0, 1.0, static_cast<int>(f), 0.0, 1.0);
    CHECK(report.largest_gap < 1e-14);
  }
}

TEST_CASE("nodes that agree but for round-off are one breakpoint, and nothing is lost")
{
  Outline x;
  for (int i = 0; i <= 10; ++i) x.emplace_back(0.1 * i + (i % 10 == 0 ? 0.0 : 3e-13 * (i % 3 - 1)), 0.0);
  const auto source = polyline(x), target = along(flat, 10);

  const auto [pieces, report] = overlay(source, target);

  CHECK(pieces.size() == 10);
  check_pieces(source, target, pieces);
}

TEST_CASE("corners that lie 0.2 of a face apart are the same corner")
{
  const auto source = polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, {5, 5, 5, 5});
  const auto target = polygon({{-0.03, -0.02}, {1.02, -0.03}, {1.03, 1.02}, {-0.02, 1.03}}, {4, 7, 4, 7});

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  CHECK(report.unmatched_source_features.count == 0);
  CHECK(report.unmatched_target_features.count == 0);
  for (const auto& p : pieces) { // each side lies over its own side
    const int side = p.source_face / 5;
    const int first[] = {0, 4, 11, 15, 22};
    CHECK(p.target_face >= first[side]);
    CHECK(p.target_face < first[side + 1]);
  }
}

TEST_CASE("corners that only one side has are kept and named")
{
  const auto source = polyline({{0.0, 0.0}, {0.5, 0.0}, {1.0, 0.5}, {1.0, 1.0}}); // 45 degrees, twice
  const auto target = polyline({{0.0, 0.0}, {0.4, 0.0}, {0.75, 0.1}, {0.95, 0.3}, {1.0, 0.6}, {1.0, 1.0}});

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  CHECK(report.unmatched_source_features.first == std::vector<std::int32_t>{1, 2});
  CHECK(report.unmatched_target_features.count == 0); // turns by 16, 29, 31 and 14 degrees
  CHECK(report.covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
}

TEST_CASE("the angle of a corner is an option")
{
  const auto mesh = polyline({{0.0, 0.0}, {1.0, 0.0}, {2.0, 1.0}}); // 45 degrees
  const auto other = polyline({{0.0, 0.0}, {2.0, 1.0}});

  CHECK(overlay(mesh, other).report.unmatched_source_features.first == std::vector<std::int32_t>{1});
  CHECK(overlay(mesh, other, {.feature_angle = 0.8}).report.unmatched_source_features.count == 0);
}

TEST_CASE("two bodies do not mix")
{
  const auto source = both(along(flat, 5), along([](double s) { return Eigen::Vector2d(s, 0.3); }, 7));
  const auto target = both(along([](double s) { return Eigen::Vector2d(s, 0.301); }, 6), along(flat, 4));

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  for (const auto& p : pieces) CHECK((p.source_face < 5) == (p.target_face >= 6));
  CHECK(report.largest_gap == doctest::Approx(0.001).epsilon(1e-9));
}

TEST_CASE("the two sides of a plate do not mix, though it is thinner than its faces")
{
  const double d = 0.01; // faces are 0.1 and 0.0667
  const auto source = polygon({{0, 0}, {1, 0}, {1, d}, {0, d}}, {10, 1, 10, 1});
  const auto target = polygon({{0, 0}, {1, 0}, {1, d}, {0, d}}, {15, 1, 15, 1});
  for (const auto& fluid : {source, reversed(source)}) {
    const auto [pieces, report] = overlay(fluid, target);

    check_pieces(fluid, target, pieces);
    CHECK(report.unmatched_source_features.count == 0);
    for (const auto& p : pieces) {
      const double y = face_centre(fluid, p.source_face).y();
      CHECK(face_centre(target, p.target_face).y() == doctest::Approx(y).epsilon(1e-12));
    }
  }
}

TEST_CASE("a source may cover a part of a loop, and a loop may reach beyond a target that covers a part of it")
{
  const auto around = [](double from, double to, int n) {
    return along(
        [=](double s) {
          const double a = from + (to - from) * s;
          return Eigen::Vector2d(std::cos(a), std::sin(a));
        },
        n);
  };
  const auto ring = [&](int n) {
    Outline x;
    for (int i = 0; i < n; ++i)
      x.emplace_back(std::cos(6.283185307179586 * i / n), std::sin(6.283185307179586 * i / n));
    return polyline(x, true);
  };
  const auto part = around(-1.0, 2.0, 20), loop = ring(50);

  const auto on_loop = overlay(part, loop);
  check_pieces(part, loop, on_loop.pieces);
  CHECK(on_loop.report.covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(on_loop.report.target_covered_fraction == doctest::Approx(3.0 / 6.283185).epsilon(0.01)); // chords for arcs

  const auto from_loop = overlay(loop, part);
  check_pieces(loop, part, from_loop.pieces);
  CHECK(from_loop.report.covered_fraction == doctest::Approx(3.0 / 6.283185).epsilon(0.02));
  CHECK(from_loop.report.target_covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(from_loop.report.uncovered_faces.count == 26); // numbers 16 to 41: faces of 0.1257 between 2 and 2 pi - 1
}

TEST_CASE("a source passes a branch of the target")
{
  auto target = polyline({{0.0, 0.0}, {0.3, 0.0}, {0.6, 0.0}, {1.0, 0.0}, {0.6, -0.5}});
  target.face_nodes = {0, 1, 1, 2, 2, 3, 2, 4}; // the last face hangs down from node 2
  const auto source = along(flat, 8);

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  for (const auto& p : pieces) CHECK(p.target_face < 3);
  CHECK(report.target_covered_fraction > 0.6); // 1 / 1.5 of it, less what a face at the branch gives its neighbour
}

TEST_CASE("faces without length are skipped and counted")
{
  const auto source = polyline({{0.0, 0.0}, {0.4, 0.0}, {0.4, 0.0}, {1.0, 0.0}});
  const auto target = polyline({{0.0, 0.0}, {0.7, 0.0}, {0.7, 0.0}, {1.0, 0.0}});

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  CHECK(report.skipped_source_faces.first == std::vector<std::int32_t>{1});
  CHECK(report.skipped_target_faces.first == std::vector<std::int32_t>{1});
  CHECK(report.covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
  for (const auto& p : pieces) CHECK(p.source_face != 1);
}

TEST_CASE("surfaces that do not face each other at all still keep every source face")
{
  const auto source = along(flat, 4), target = along([](double s) { return Eigen::Vector2d(5.0, s); }, 3);

  const auto [pieces, report] = overlay(source, target);

  check_pieces(source, target, pieces);
  CHECK(report.largest_gap > 3.9);
}

TEST_CASE("outlines at random are covered once, whatever their shape")
{
  std::mt19937_64 engine{61};
  const auto number = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11) * 0x1p-53;
  };
  for (int i = 0; i < 300; ++i) {
    // Stars of up to nine rays, some with real corners; the target is another mesh of the same shape with a gap.
    const double rays = std::floor(number(2.0, 10.0)), depth = number(0.0, 0.5), sharpness = number(0.0, 1.0);
    const auto radius = [&](double a) {
      const double wave = std::cos(rays * a);
      return 1.0 + depth * ((1.0 - sharpness) * wave + sharpness * std::copysign(1.0 - std::abs(wave), wave));
    };
    const auto star = [&](double gap, bool is_loop) {
      const int n = 8 + static_cast<int>(number(0.0, 90.0));
      const double turn = number(0.0, 6.0);
      Outline x;
      for (int k = 0; k < n; ++k) {
        const double a = turn + 6.283185307179586 * (k + number(-0.4, 0.4)) / n * (is_loop ? 1.0 : 0.7);
        x.emplace_back((radius(a) + gap) * std::cos(a), (radius(a) + gap) * std::sin(a));
      }
      return polyline(x, is_loop);
    };
    SurfaceMesh source = star(0.0, number(0.0, 1.0) < 0.7), target = star(number(-0.05, 0.05), number(0.0, 1.0) < 0.7);
    if (number(0.0, 1.0) < 0.5) source = reversed(source);
    CAPTURE(i);

    const auto [pieces, report] = overlay(source, target);

    check_pieces(source, target, pieces);
    if (report.covered_fraction < 1.0 || report.target_covered_fraction < 1.0) continue; // one of them is open
    // Two loops: no place is paired with another that is much farther than the surfaces are from each other.
    const FaceTree on_source(source), on_target(target);
    double distance = 0.0;
    for (std::int64_t k = 0; k < source.n_nodes(); ++k)
      distance = worst(distance, on_target.closest(node_position(source, k)).distance);
    for (std::int64_t k = 0; k < target.n_nodes(); ++k)
      distance = worst(distance, on_source.closest(node_position(target, k)).distance);
    CHECK(report.largest_gap <= 3.0 * distance); // in spikes the normals are not those of the closest points
  }
}
