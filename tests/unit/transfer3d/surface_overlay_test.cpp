// The overlay of two surfaces: what it covers, what its pieces say, and what it is worth for a transfer.
#include "surface/surface_overlay.hpp"

#include "support/overlay_assembly.hpp"
#include "support/overlay_meshes.hpp"
#include "surface/nodal_normals.hpp"
#include "surface/plane_face.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

using namespace mullion::testing;
using namespace mullion::surface;

namespace {

Eigen::VectorXd at_nodes(const SurfaceMesh& mesh, double (*field)(const Point&))
{
  Eigen::VectorXd values(mesh.n_nodes());
  for (Eigen::Index i = 0; i < mesh.n_nodes(); ++i) values[i] = field(mesh.nodes.col(i));
  return values;
}

double one(const Point&) { return 1.0; }
double linear(const Point& x) { return 1.0 + 2.0 * x.x() - 3.0 * x.y() + 0.5 * x.z(); }

/// Largest error of the recovered nodal values.
double error_of(const OverlayMatrices& m, const SurfaceMesh& source, const SurfaceMesh& target,
                double (*field)(const Point&))
{
  const Eigen::VectorXd error = recovered(m, m.nodal * at_nodes(source, field)) - at_nodes(target, field);
  return error.lpNorm<Eigen::Infinity>();
}

/// Every piece is sound: ordered, within its faces. True of every overlay.
void check_pieces(const OverlayMatrices& m)
{
  CHECK(m.is_ordered);
  CHECK(m.is_finite_and_inside);
}

const std::vector<Faces> all_kinds = {Faces::triangles, Faces::quadrilaterals, Faces::mixed};

} // namespace

TEST_CASE("on identical meshes every pair of faces is a face with itself, and B is the mass matrix")
{
  for (const auto& surface : {SurfaceMap(flat), cap(2.0), SurfaceMap(wing)})
    for (const Faces faces : all_kinds) {
      const auto mesh = grid_on(surface, {6, 5, faces, 0.24, 1});

      const auto m = assemble(mesh, mesh, {.opposite = false});

      check_pieces(m);
      int n_parts = 0; // warped quadrilaterals of the wing are cut in two
      const auto normals = nodal_normals(mesh);
      for (std::int32_t f = 0; f < mesh.n_faces(); ++f) n_parts += plane_face(mesh, f, normals).n_parts;
      CHECK(m.n_pieces == n_parts);
      CHECK((m.nodal - m.source_mass).norm() < 1e-13 * m.source_mass.norm()); // round-off
      CHECK((m.nodal - m.target_mass).norm() < 1e-13 * m.source_mass.norm());
    }
}

TEST_CASE("flat meshes that do not match cover each other once, face by face")
{
  for (const Faces source_faces : all_kinds)
    for (const Faces target_faces : all_kinds) {
      const auto source = grid_on(flat, {9, 8, source_faces, 0.24, 1});
      const auto target = turned_over(grid_on(flat, {7, 11, target_faces, 0.24, 2}));

      const auto m = assemble(source, target);

      check_pieces(m);
      for (std::int32_t f = 0; f < source.n_faces(); ++f)
        CHECK(std::abs(m.source_area[f] / face_measure(source, f) - 1.0) < 1e-12); // round-off
      for (std::int32_t t = 0; t < target.n_faces(); ++t)
        CHECK(std::abs(m.target_area[t] / face_measure(target, t) - 1.0) < 1e-12);
      CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12);
      CHECK(std::abs(m.report.max_coverage - 1.0) < 1e-12);
      CHECK(m.report.covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
      CHECK(m.report.target_covered_fraction == doctest::Approx(1.0).epsilon(1e-12));
      CHECK(m.report.partly_covered_faces.count == 0);
      CHECK(m.report.uncovered_faces.count == 0);
      CHECK(m.report.unmatched_target_nodes.count == 0);
      CHECK(m.report.largest_gap < 1e-15);
    }
}

TEST_CASE("flat meshes carry linear fields over exactly, also between distorted quadrilaterals")
{
  for (const Faces source_faces : all_kinds)
    for (const Faces target_faces : all_kinds) {
      const auto source = grid_on(flat, {9, 8, source_faces, 0.24, 1});
      const auto target = turned_over(grid_on(flat, {7, 11, target_faces, 0.24, 2}));

      const auto m = assemble(source, target);

      CHECK(error_of(m, source, target, linear) < 1e-12); // round-off times the condition of a mass matrix, 10 or so
    }
}

TEST_CASE("flat meshes a distance apart are covered and carry linear fields as if there were none")
{
  const auto source = grid_on(flat, {9, 8, Faces::mixed, 0.24, 1});
  const Point normal = Point(0.8, 0.36, 0.48).cross(Point(-0.1, 0.7, -0.35)).normalized();
  const auto target =
      moved(grid_on(flat, {7, 11, Faces::mixed, 0.24, 2}), [&](const Point& x) { return Point(x + 0.05 * normal); });

  const auto m = assemble(source, target);

  check_pieces(m);
  CHECK(std::abs(m.report.min_coverage - 1.0) < 1e-12); // round-off
  CHECK(m.report.largest_gap == doctest::Approx(0.05).epsilon(1e-12));
  const Eigen::VectorXd found = recovered(m, m.nodal * at_nodes(source, linear));
  for (Eigen::Index i = 0; i < target.n_nodes(); ++i)
    CHECK(std::abs(found[i] - linear(target.nodes.col(i) - 0.05 * normal)) < 1e-12);
}

TEST_CASE("constants, and the total of a load, are kept on every surface with and without a gap")
{
  struct Pair {
    std::string name;
    SurfaceMap source, target;
  };
  const std::vector<Pair> pairs = {{"flat", flat, flat},
                                   {"cap", cap(2.0), cap(2.0)},
                                   {"cap, gap outwards", cap(2.0), cap(2.05)},
                                   {"cap, gap inwards", cap(2.0), cap(1.95)},
                                   {"wing", wing, wing}};
  for (const auto& pair : pairs)
    for (const Faces faces : all_kinds) {
      CAPTURE(pair.name);
      const auto source = grid_on(pair.source, {16, 12, faces, 0.24, 1});
      const auto target = turned_over(grid_on(pair.target, {13, 14, faces, 0.24, 2}));

      const auto m = assemble(source, target);

      check_pieces(m);
      CHECK(m.report.uncovered_faces.count == 0);
      CHECK(error_of(m, source, target, one) < 1e-12); // round-off times the condition of a mass matrix, 10 or so
      const double area = total_measure(source);
      CHECK(std::abs((m.nodal * at_nodes(source, one)).sum() - area) < 1e-12 * area);
      CHECK(std::abs(m.facial.sum() - area) < 1e-12 * area);
      const Eigen::VectorXd force = m.nodal.transpose() * Eigen::VectorXd::Ones(target.n_nodes());
      const Eigen::VectorXd of_source = m.source_mass * Eigen::VectorXd::Ones(source.n_nodes());
      CHECK((force - of_source).lpNorm<Eigen::Infinity>() < 1e-12 * of_source.lpNorm<Eigen::Infinity>());
    }
}

TEST_CASE("a source face away from the rim is covered exactly once, whatever the gap and the curvature")
{
  for (const double radius : {1.9, 1.97, 2.0, 2.03, 2.1}) {
    const auto source = grid_on(cap(2.0), {10, 10, Faces::mixed, 0.24, 1});
    const auto target = turned_over(grid_on(cap(radius), {8, 9, Faces::mixed, 0.24, 2}));

    const auto m = assemble(source, target);

    for (std::int32_t f = 0; f < source.n_faces(); ++f) {
      const Point centre = face_centre(source, f) / 2.0;
      if (std::max(std::abs(centre.x() / centre.z()), std::abs(centre.y() / centre.z())) > 0.26) continue; // rim: 0.35
      // Triangles: round-off. Quadrilaterals are not plane: pieces in the mean plane, areas on the bilinear surface,
      // which leans against it by warp / size ~ h / R = 0.07 at most, and 0.07^2 / 2 of it is the area's difference.
      const double tolerance = source.face(f).size() == 3 ? 1e-12 : 2.5e-3;
      CHECK(std::abs(m.source_area[f] / face_measure(source, f) - 1.0) < tolerance);
    }
    CHECK(m.report.max_coverage < 1.0 + 1e-12);
    // The target's share off 1: O(h / R)^2 inside; at the rim normals are one-sided, half a face's angle of 0.08 off,
    // which a gap of 0.1 turns into a strip of 0.004 along four sides of 1.4 of a square of 2.
    CHECK(std::abs(m.report.target_covered_fraction - 1.0) < 2e-2);
  }
}

TEST_CASE("meshes of one sphere pair points that are as far apart as chord and arc")
{
  const auto source = grid_on(cap(2.0), {10, 10, Faces::triangles, 0.24, 1});
  const auto target = turned_over(grid_on(cap(2.0), {8, 9, Faces::triangles, 0.24, 2}));

  const auto m = assemble(source, target);

  // Sagitta l^2 / (8 R) of the longest chord: the diagonal of a cell of 1.4 / 8, shifted by up to 0.24 at either end.
  const double longest = 1.48 * std::sqrt(2.0) * 1.4 / 8.0;
  CHECK(m.report.largest_gap < longest * longest / (8.0 * 2.0) * 1.34); // the circumcircle's sagitta: up to 4/3 of it
  CHECK(m.report.largest_gap > 1e-4);
}

TEST_CASE("pieces follow the places on both sides")
{
  const auto source = grid_on(cap(2.0), {6, 6, Faces::mixed, 0.24, 1});
  const auto target = turned_over(grid_on(cap(2.02), {5, 7, Faces::mixed, 0.24, 2}));
  double farthest = 0.0, nearest = 1.0, sideways = 0.0;
  overlay_surfaces(source, target, {}, [&](const Subelement& piece) {
    for (int k = 0; k < piece.n_vertices; ++k) {
      const Point x_f = map_to_space(source, piece.source_face, piece.source_xi[k]);
      const Point x_s = map_to_space(target, piece.target_face, piece.target_xi[k]);
      farthest = std::max(farthest, (x_s - x_f).norm());
      nearest = std::min(nearest, (x_s - x_f).norm());
      sideways = std::max(sideways, (x_s - x_f).cross(x_f.normalized()).norm());
    }
  });

  // The gap of 0.02 less the source's sagitta, plus the target's: 0.3^2 / 16 = 6e-3 or so each.
  CHECK(nearest > 0.005);
  CHECK(farthest < 0.035);
  // Gap times the error of the normals, which are exact inside and one-sided at the rim: half an angle of 0.1.
  CHECK(sideways < 0.05 * farthest + 1e-3);
}

TEST_CASE("the orientation is found, and does not matter once it is known")
{
  const auto source = grid_on(wing, {20, 8, Faces::triangles, 0.24, 1});
  const auto target = grid_on(wing, {17, 9, Faces::triangles, 0.24, 2});

  const auto same = assemble(source, target), opposite = assemble(source, turned_over(target));
  const auto given = assemble(source, target, {.opposite = false});

  CHECK_FALSE(same.report.is_opposite);
  CHECK(opposite.report.is_opposite);
  CHECK(same.n_pieces == given.n_pieces);
  CHECK((same.nodal - given.nodal).norm() == 0.0);
  CHECK((same.nodal - opposite.nodal).norm() < 1e-12 * same.nodal.norm()); // round-off: corners in another order
}

TEST_CASE("with the wrong orientation nothing is a pair")
{
  const auto mesh = grid_on(flat, {3, 3, Faces::triangles, 0.2, 1});

  const auto m = assemble(mesh, mesh, {.opposite = true});

  CHECK(m.n_pieces == 0);
  CHECK(m.report.uncovered_faces.count == mesh.n_faces());
  CHECK(m.report.unmatched_target_nodes.count == mesh.n_nodes());
  CHECK(m.report.min_coverage == 0.0);
  CHECK(m.report.covered_fraction == 0.0);
}

TEST_CASE("surfaces farther apart than the tolerance are no pair, nearer ones are")
{
  const auto source = grid_on(flat, {5, 5, Faces::triangles, 0.2, 1});
  const Point normal = Point(0.8, 0.36, 0.48).cross(Point(-0.1, 0.7, -0.35)).normalized();
  const auto target =
      moved(grid_on(flat, {4, 4, Faces::triangles, 0.2, 2}), [&](const Point& x) { return Point(x + 0.7 * normal); });

  const auto far = assemble(source, target); // by default twice a face's size: 2 * sqrt(0.8 / 32) = 0.3
  const auto near = assemble(source, target, {.gap_tolerance = 0.71});
  const auto just_not = assemble(source, target, {.gap_tolerance = 0.69});

  CHECK(far.report.uncovered_faces.count == source.n_faces());
  CHECK(std::abs(near.report.min_coverage - 1.0) < 1e-12);
  CHECK(near.report.largest_gap == doctest::Approx(0.7).epsilon(1e-12));
  CHECK(just_not.report.uncovered_faces.count == source.n_faces());
  CHECK(just_not.report.uncovered_faces.first.size() == FaceList::max_listed);
}

TEST_CASE("two builds of an overlay have the same bits")
{
  const auto source = grid_on(wing, {12, 7, Faces::mixed, 0.24, 1});
  const auto target = turned_over(grid_on(wing, {11, 9, Faces::mixed, 0.24, 2}));

  const auto first = assemble(source, target), second = assemble(source, target);

  CHECK(first.n_pieces == second.n_pieces);
  CHECK((first.nodal - second.nodal).norm() == 0.0);
  CHECK(first.report.min_coverage == second.report.min_coverage);
}

TEST_CASE("the overlay does not depend on where the surfaces lie, nor on their size")
{
  const auto source = grid_on(cap(2.0), {9, 8, Faces::triangles, 0.24, 1});
  const auto target = turned_over(grid_on(cap(2.01), {7, 8, Faces::triangles, 0.24, 2}));
  const auto reference = assemble(source, target);

  for (const double scale : {1e-6, 1e3}) {
    const auto motion = [&](const Point& x) {
      return Point(scale * Point(x.y() + 5.0, x.z() - 3.0, x.x() + 7.0)); // turned and shifted
    };
    const auto m = assemble(moved(source, motion), moved(target, motion));

    CHECK(m.n_pieces == reference.n_pieces);
    const Sparse difference = m.nodal / (scale * scale) - reference.nodal;
    CHECK(difference.norm() < 1e-12 * reference.nodal.norm()); // round-off of places at a distance of 5 or 10
  }
}

TEST_CASE("a swept wing is covered inside, and its sides are not mixed up at the sharp trailing edge")
{
  const auto source = grid_on(wing, {64, 16, Faces::triangles, 0.24, 1});
  const auto target = turned_over(grid_on(wing, {56, 14, Faces::triangles, 0.24, 2}));
  // Nodes are numbered along the section: the first half of a row is the lower side.
  const auto is_lower = [](const SurfaceMesh& mesh, std::int32_t face, int n_u) {
    double column = 0.0;
    for (const auto node : mesh.face(face)) column += node % (n_u + 1);
    return column / static_cast<double>(mesh.face(face).size()) < 0.5 * n_u;
  };
  int n_mixed = 0;
  double farthest_mixed = 0.0;
  const auto report = overlay_surfaces(source, target, {}, [&](const Subelement& piece) {
    if (is_lower(source, piece.source_face, 64) == is_lower(target, piece.target_face, 56)) return;
    ++n_mixed;
    // From the nose, 25 % of the chord in front of the quarter line: 1.5 v tan(30 degrees) there.
    const Point x = face_centre(source, piece.source_face);
    farthest_mixed = std::max(farthest_mixed, x.x() - x.y() * std::tan(std::numbers::pi / 6.0));
  });

  CHECK(report.uncovered_faces.count == 0);
  CHECK(report.max_coverage < 1.0 + 1e-9);
  CHECK(report.min_coverage > 0.9);
  CHECK(report.covered_fraction > 0.999);
  CHECK(n_mixed > 0);           // at the nose sides meet
  CHECK(farthest_mixed < 0.25); // and nowhere near the trailing edge
}
