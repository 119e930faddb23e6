// Surfaces on which overlays tend to break, each by name.
#include "surface/surface_overlay.hpp"

#include "support/overlay_assembly.hpp"
#include "support/overlay_meshes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <utility>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

void check_sound(const OverlayMatrices& m)
{
  CHECK(m.is_ordered);
  CHECK(m.is_finite_and_inside);
  CHECK(m.source_area.allFinite());
}

Point unit_square(double u, double v) { return {u, v, 0.0}; }

/// Area of the source that pieces stand for [m^2].
double area_of(const OverlayMatrices& m) { return m.source_area.sum(); }

} // namespace

TEST_CASE("nested meshes, whose nodes and edges coincide, have a piece per fine face")
{
  const auto fine = grid_on(flat, {12, 8, Faces::quadrilaterals}),
             coarse = grid_on(flat, {6, 4, Faces::quadrilaterals});

  for (const auto& [source, target] : {std::pair(fine, coarse), std::pair(coarse, fine)}) {
    const auto m = assemble(source, target);

    check_sound(m);
    CHECK(m.n_pieces == fine.n_faces());
    CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // round-off
    CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12);
  }
}

TEST_CASE("edges of one mesh along the diagonals of the other are no trouble")
{
  const auto quadrilaterals = grid_on(flat, {6, 6, Faces::quadrilaterals});
  const auto triangles = grid_on(flat, {6, 6, Faces::triangles, 0.0, 4});

  const auto m = assemble(quadrilaterals, triangles), back = assemble(triangles, quadrilaterals);

  CHECK(m.n_pieces == triangles.n_faces());
  CHECK(back.n_pieces == triangles.n_faces());
  CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // round-off
  CHECK(std::abs(back.report.min_coverage - 1.0) < 1e-12);
}

TEST_CASE("slivers cover and are covered like other faces")
{
  for (const double thinness : {1e-3, 1e-6, 1e-8}) {
    // Rows of nodes that lie `thinness` apart.
    const auto rows = [&](double u, double v) {
      const double row = std::round(4.0 * v);
      return Point(u, 0.5 * std::floor(0.5 * row) + (std::fmod(row, 2.0) == 1.0 ? thinness : 0.0), 0.0);
    };
    const auto thin = grid_on(rows, {7, 4, Faces::triangles, 0.0, 1});
    const auto other = turned_over(grid_on(unit_square, {5, 6, Faces::triangles, 0.2, 2}));

    const auto m = assemble(thin, other), back = assemble(other, thin);

    check_sound(m);
    check_sound(back);
    // Pieces below 1e-14 length^2 are dropped, of an area of thinness * length / 2; few of a length of 1/7.
    CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-14 / thinness);
    CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-14 / thinness);
    CHECK(std::abs(area_of(back) - 1.0) < 1e-12);
    CHECK(std::abs(back.report.min_coverage - 1.0) < 1e-12);
  }
}

TEST_CASE("flat caps, triangles with an angle of almost 180 degrees, neither tear nor turn their neighbours")
{
  // The node in the middle of an edge is lifted by 1e-9 of its length: the triangle below it is a cap.
  const auto capped = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 1e-9, 0}},
                              {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}});
  const auto other = grid_on(unit_square, {4, 3, Faces::mixed, 0.2, 2});

  const auto m = assemble(other, capped), back = assemble(capped, other);

  check_sound(m);
  CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // round-off
  CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12);
  CHECK(back.report.skipped_source_faces.count == 0);
  CHECK(std::abs(back.report.min_coverage - 1.0) < 1e-6); // 1e-16 over the cap's height of 1e-9
}

TEST_CASE("faces without area are skipped and reported on both sides")
{
  auto source = grid_on(unit_square, {3, 3, Faces::triangles, 0.2, 1});
  auto target = grid_on(unit_square, {4, 4, Faces::quadrilaterals, 0.2, 2});
  const auto n_source = static_cast<std::int32_t>(source.n_faces()),
             n_target = static_cast<std::int32_t>(target.n_faces());
  add_face(source, {0, 1, 2});    // three nodes of the straight boundary
  add_face(target, {0, 1, 2, 3}); // four
  add_face(target, {1, 2, 3});

  const auto m = assemble(source, target);

  check_sound(m);
  REQUIRE(m.report.skipped_source_faces.count == 1);
  CHECK(m.report.skipped_source_faces.first[0] == n_source);
  REQUIRE(m.report.skipped_target_faces.count == 2);
  CHECK(m.report.skipped_target_faces.first[0] == n_target);
  CHECK(m.report.skipped_target_faces.first[1] == n_target + 1);
  CHECK(m.source_area[n_source] == 0.0);
  CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // round-off
  CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12);
}

TEST_CASE("a mesh of faces without area is no reason to fail")
{
  const auto line = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  const auto mesh = grid_on(unit_square, {2, 2, Faces::triangles});

  const auto onto = assemble(mesh, line), from = assemble(line, mesh);

  CHECK(onto.n_pieces == 0);
  CHECK(onto.report.uncovered_faces.count == mesh.n_faces());
  CHECK(from.n_pieces == 0);
  CHECK(from.report.covered_fraction == 0.0);
}

TEST_CASE("T-junctions in a plane leave no hole")
{
  // Two faces on the left of x = 0.5, three on the right: four nodes hang on edges.
  const auto hanging = mesh_of({{0, 0, 0},
                                {0.5, 0, 0},
                                {0.5, 0.5, 0},
                                {0, 0.5, 0},
                                {0.5, 1, 0},
                                {0, 1, 0},
                                {1, 0, 0},
                                {1, 0.3, 0},
                                {0.5, 0.3, 0},
                                {1, 0.6, 0},
                                {0.5, 0.6, 0},
                                {1, 1, 0}},
                               {{0, 1, 2, 3}, {3, 2, 4, 5}, {1, 6, 7, 8}, {8, 7, 9, 10}, {10, 9, 11, 4}});
  const auto other = turned_over(grid_on(unit_square, {5, 7, Faces::triangles, 0.2, 2}));

  const auto m = assemble(other, hanging), back = assemble(hanging, other);

  for (const auto* side : {&m, &back}) {
    check_sound(*side);
    CHECK(std::abs(side->report.min_coverage - 1.0) < 1e-12); // round-off
    CHECK(std::abs(side->report.max_coverage - 1.0) < 1e-12);
    CHECK(std::abs(area_of(*side) - 1.0) < 1e-12);
  }
}

TEST_CASE("a seam whose nodes are there twice does not tear, even across a gap")
{
  const auto half = [](double from, double to) {
    return [from, to](double u, double v) { return cap(2.05)(from + (to - from) * u, v); };
  };
  const auto whole = grid_on(cap(2.05), {8, 6, Faces::quadrilaterals});
  const auto halves = joined(grid_on(half(0.0, 0.5), {4, 6, Faces::quadrilaterals}),
                             grid_on(half(0.5, 1.0), {4, 6, Faces::quadrilaterals}));
  const auto source = turned_over(grid_on(cap(2.0), {9, 7, Faces::triangles, 0.2, 1}));

  const auto m = assemble(source, halves), reference = assemble(source, whole);

  check_sound(m);
  CHECK(halves.n_nodes() == whole.n_nodes() + 7);
  CHECK(m.n_pieces == reference.n_pieces);
  // The same but for the nodes of the seam at the rim, whose normals are means of two, not of one row.
  CHECK(std::abs(m.report.covered_fraction - reference.report.covered_fraction) < 1e-4);
  CHECK(m.report.max_coverage < 1.0 + 1e-12);
}

TEST_CASE("a face that is there twice is covered twice by the report, and its double is asked for no less")
{
  auto target = grid_on(unit_square, {4, 4, Faces::triangles, 0.2, 2});
  const auto source = grid_on(unit_square, {3, 3, Faces::triangles, 0.2, 1});
  const auto doubled = joined(target, target);

  const auto m = assemble(source, doubled);

  check_sound(m);
  CHECK(std::abs(m.report.min_coverage - 2.0) < 1e-12); // round-off
  const double area = m.nodal.sum();
  CHECK(std::abs(area - 1.0) < 1e-12); // the total of a load is still kept: faces are scaled
}

TEST_CASE("at a folded corner faces go to their own side, and a gap around the corner is bridged")
{
  for (const double gap : {0.0, 0.04, -0.04}) {
    // An L of two unit squares that meet in a right angle along y; the other one at a distance all around.
    const auto corner = [](double offset) {
      return [offset](double u, double v) {
        return u <= 0.5 ? Point((1.0 + offset) * 2.0 * u, v, 1.0 + offset)
                        : Point(1.0 + offset, v, (1.0 + offset) * (2.0 - 2.0 * u));
      };
    };
    const auto source = grid_on(corner(0.0), {8, 5, Faces::triangles, 0.0, 1});
    const auto target = turned_over(grid_on(corner(gap), {6, 7, Faces::mixed, 0.0, 2}));
    bool is_mixed = false;
    overlay_surfaces(source, target, {}, [&](const Subelement& piece) {
      is_mixed = is_mixed ||
                 std::abs(face_normal(source, piece.source_face).dot(face_normal(target, piece.target_face))) < 0.5;
    });

    const auto m = assemble(source, target);

    check_sound(m);
    CHECK_FALSE(is_mixed);
    // Normals at the fold halve the angle, so each corner lies on the other's line: nothing is left out, nothing twice.
    // At the open ends the sides do not reach equally far if there is a gap, 0.04 of a face of 1/4.
    CHECK(m.report.max_coverage < 1.0 + 1e-12);
    CHECK(m.report.min_coverage > (gap == 0.0 ? 1.0 - 1e-12 : 1.0 - 0.04 * 4.0 - 1e-12));
    CHECK(m.report.covered_fraction > (gap < 0.0 ? 1.0 - 0.04 : 1.0 - 1e-12));
  }
}

TEST_CASE("the sheets of a thin body are not mixed up")
{
  for (const double thickness : {1e-1, 1e-2, 1e-4}) {
    const auto body = [&](int n, unsigned seed) {
      const auto lift = [&](double z) {
        return [z](double u, double v) { return Point(u, v, 0.1 * std::sin(3.0 * u) + z); };
      };
      return joined(grid_on(lift(thickness), {n, n, Faces::triangles, 0.2, seed}),
                    turned_over(grid_on(lift(0.0), {n, n, Faces::triangles, 0.2, seed + 1})));
    };
    const auto source = body(9, 1), target = turned_over(body(7, 3));
    int n_mixed = 0;
    const auto report = overlay_surfaces(source, target, {.opposite = true}, [&](const Subelement& piece) {
      n_mixed += (piece.source_face < source.n_faces() / 2) != (piece.target_face < target.n_faces() / 2) ? 1 : 0;
    });

    CHECK(n_mixed == 0);
    CHECK(report.uncovered_faces.count == 0);
    CHECK(report.max_coverage < 1.0 + 1e-12);
    CHECK(report.min_coverage > 0.99); // rim: chords of different length
  }
}

TEST_CASE("a second layer behind the first one is left alone")
{
  const auto at = [](double z) { return [z](double u, double v) { return Point(u, v, z); }; };
  const auto source = grid_on(at(0.0), {6, 6, Faces::triangles, 0.2, 1});
  const auto target = joined(grid_on(at(0.15), {5, 5, Faces::triangles, 0.2, 2}), // within the tolerance of 0.28
                             grid_on(at(0.001), {5, 5, Faces::triangles, 0.2, 3}));

  const auto m = assemble(source, target);

  CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12); // round-off
  CHECK(m.report.largest_gap < 0.002);
}

TEST_CASE("where the source reaches beyond the target, the report says how far")
{
  const auto source = grid_on(unit_square, {10, 6, Faces::triangles, 0.2, 1});
  const auto target =
      grid_on([](double u, double v) { return Point(0.37 * u, v, 0.0); }, {5, 5, Faces::triangles, 0.2, 2});

  const auto m = assemble(source, target), back = assemble(target, source);

  check_sound(m);
  CHECK(m.report.covered_fraction == doctest::Approx(0.37).epsilon(1e-12));
  CHECK(m.report.target_covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
  CHECK(m.report.uncovered_faces.count > 0);
  CHECK(m.report.partly_covered_faces.count > 0);
  CHECK(area_of(m) == doctest::Approx(0.37).epsilon(1e-12));
  for (const auto f : m.report.uncovered_faces.first) CHECK(m.source_area[f] == 0.0);
  CHECK(std::abs(back.report.min_coverage - 1.0) < 1e-12); // round-off
  CHECK(back.report.target_covered_fraction == doctest::Approx(0.37).epsilon(1e-12));
  CHECK(back.report.unmatched_target_nodes.count > 0);
}

TEST_CASE("a hole in the target stays one")
{
  auto target = grid_on(unit_square, {5, 5, Faces::quadrilaterals});
  SurfaceMesh holed;
  holed.nodes = target.nodes;
  for (std::int64_t f = 0; f < target.n_faces(); ++f)
    if (f != 12) add_face(holed, {target.face(f).begin(), target.face(f).end()}); // the middle, an area of 1/25
  const auto source = grid_on(unit_square, {13, 11, Faces::triangles, 0.2, 1});

  const auto m = assemble(source, holed);

  check_sound(m);
  CHECK(m.report.covered_fraction == doctest::Approx(24.0 / 25.0).epsilon(1e-12));
  CHECK(m.report.uncovered_faces.count > 0);
  CHECK(m.report.partly_covered_faces.count > 0);
  CHECK(m.report.max_coverage < 1.0 + 1e-12);
}

TEST_CASE("surfaces that run through each other are covered on either side")
{
  const auto wave = [](double u, double v) { return Point(u, v, 0.02 * std::sin(9.0 * u) * std::cos(7.0 * v)); };
  const auto source = grid_on(unit_square, {9, 9, Faces::triangles, 0.2, 1});
  const auto target = turned_over(grid_on(wave, {11, 8, Faces::triangles, 0.2, 2}));

  const auto m = assemble(source, target);

  check_sound(m);
  CHECK(m.report.max_coverage < 1.0 + 1e-12);
  // Nodal normals lean by up to 0.02 * 9, so nodes at the rim move by up to 0.02 * 0.18 into the square, in a face of
  // 0.1: a strip of 4 %.
  CHECK(m.report.min_coverage > 0.95);
  CHECK(m.report.covered_fraction > 0.99);
  CHECK(m.report.largest_gap > 0.01);
  CHECK(m.report.largest_gap < 0.025);
}

TEST_CASE("quadrilaterals warped by more than ten degrees keep forces and constants")
{
  // Saddles: the corners of each cell lie alternately above and below.
  const auto saddle = [](double lift, int n) {
    return [lift, n](double u, double v) {
      const int parity = static_cast<int>(std::round(u * n) + std::round(v * n)) % 2;
      return Point(u, v, parity == 0 ? lift : -lift);
    };
  };
  for (const double lift : {0.02, 0.05, 0.1}) {
    const auto source = grid_on(saddle(lift, 5), {5, 5, Faces::quadrilaterals});
    const auto target = turned_over(grid_on(saddle(lift, 4), {4, 4, Faces::quadrilaterals}));

    const auto m = assemble(source, target, {.gap_tolerance = 1.0}),
               same = assemble(source, source, {.opposite = false});

    check_sound(m);
    check_sound(same);
    CHECK(m.report.uncovered_faces.count == 0);
    const double area = total_measure(source);
    CHECK(std::abs(m.nodal.sum() - area) < 1e-12 * area); // round-off
    const Eigen::VectorXd ones = recovered(m, m.nodal * Eigen::VectorXd::Ones(source.n_nodes()));
    CHECK((ones.array() - 1.0).abs().maxCoeff() < 1e-12); // round-off times the condition of a mass matrix
    CHECK((same.nodal - same.source_mass).norm() < 1e-13 * same.source_mass.norm());
  }
}

TEST_CASE("quadrilaterals with a corner that points inwards are covered, and cover")
{
  const auto dented = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.3, 0.35, 0}}, // a dart and its complement
                              {{0, 1, 2, 4}, {0, 4, 2, 3}});
  const auto other = turned_over(grid_on(unit_square, {4, 3, Faces::mixed, 0.2, 2}));

  const auto m = assemble(dented, other), back = assemble(other, dented);

  for (const auto* side : {&m, &back}) {
    CHECK(side->is_ordered);
    CHECK(side->is_finite_and_inside);
    CHECK(std::abs(side->report.min_coverage - 1.0) < 1e-12); // round-off
    CHECK(std::abs(side->report.max_coverage - 1.0) < 1e-12);
  }
  CHECK(std::abs(area_of(back) - 1.0) < 1e-12);
}

TEST_CASE("faces of very different sizes are matched in both directions")
{
  const auto fine = grid_on(unit_square, {60, 60, Faces::triangles, 0.2, 1});
  const auto coarse = turned_over(grid_on(unit_square, {1, 1, Faces::triangles, 0.0, 2}));

  const auto m = assemble(fine, coarse), back = assemble(coarse, fine);

  for (const auto* side : {&m, &back}) {
    check_sound(*side);
    CHECK(std::abs(side->report.min_coverage - 1.0) < 1e-11); // round-off of places of 1 in faces of 1/60
    CHECK(std::abs(side->report.max_coverage - 1.0) < 1e-11);
    CHECK(side->n_pieces < 2 * fine.n_faces());
  }
}

TEST_CASE("three sheets that meet in one edge are each covered by their own")
{
  const auto sheets = [](int n, unsigned seed) {
    SurfaceMesh mesh;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2.0 * std::acos(-1.0) / 3.0 * k;
      const auto sheet =
          grid_on([angle](double u, double v) { return Point(u * std::cos(angle), u * std::sin(angle), v); },
                  {n, n, Faces::triangles, 0.2, seed + static_cast<unsigned>(k)});
      mesh = k == 0 ? sheet : joined(mesh, sheet);
    }
    return mesh;
  };
  const auto source = sheets(5, 1), target = sheets(4, 5);

  const auto m = assemble(source, target, {.opposite = false});

  check_sound(m);
  CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // no gap: projections do not move anything
  CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12);
}
