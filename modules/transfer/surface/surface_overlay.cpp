#include "surface_overlay.hpp"

#include "aabb_tree.hpp"
#include "nodal_normals.hpp"
#include "plane_face.hpp"
#include "polygon_clip.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <utility>
#include <vector>

namespace mullion::surface {

namespace {

constexpr double least_cosine = 0.2;       // of the angle between the normals of two faces that may be a pair
constexpr double near_share = 0.1;         // of the faces' sizes: how far the first search goes
constexpr double wider = 4.0;              // each next one
constexpr double sideways_share = 0.3;     // of the search's distance, along the plane: normals lean
constexpr double piece_tolerance = 1e-14;  // of the smaller face's squared length: round-off of an area
constexpr double vertex_tolerance = 1e-14; // of the smaller face's length: round-off of a place
constexpr double full_coverage = 1.0 - 1e-9;
constexpr double least_coverage = 1e-6; // below: the noise of neighbours, no counterpart

/// What the overlay needs to know of the target.
struct Target {
  const SurfaceMesh& mesh;
  Eigen::Matrix3Xd normals; ///< at the nodes
  BoxTree tree;             ///< of the faces that are not degenerate
  bool is_opposite = false;
};

double longest_edge(const SurfaceMesh& mesh, std::int32_t f)
{
  const auto nodes = mesh.face(f);
  double square = 0.0;
  for (std::size_t k = 0; k < nodes.size(); ++k)
    square =
        std::max(square, (node_place(mesh, nodes[(k + 1) % nodes.size()]) - node_place(mesh, nodes[k])).squaredNorm());
  return std::sqrt(square);
}

/// A target face in the plane of a source face, turned so that it runs the same way round.
struct Image {
  int n = 0;
  std::array<ClipVertex, 4> vertex;
  PlaneCorners corner{}; ///< the same places
  bool is_convex = true; ///< always for a triangle
  double area = 0.0;
  double square = 0.0;      ///< of the longest edge
  double target_area = 0.0; ///< of the face itself [m^2]
};

/// False if the two faces are no pair: turned away from each other, too far apart, or without area in this plane.
bool find_image(const Target& target, std::int32_t t, const Frame& plane, double near_limit, double gap_limit,
                Image& image)
{
  const Point area_vector = twice_area_vector(target.mesh, t);
  const double twice_area = area_vector.norm();
  const double slope_of_face = plane.normal.dot(area_vector) / twice_area; // the tree has no degenerate faces
  if (!((target.is_opposite ? -slope_of_face : slope_of_face) >= least_cosine)) return false; // nor if it is NaN

  const auto nodes = target.mesh.face(t);
  const std::size_t n = nodes.size();
  const auto& local = local_corners(n);
  double least = std::numeric_limits<double>::infinity(), largest = -least;
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t j = target.is_opposite ? (n - k) % n : k;
    const auto [at, gap] = image_of_node(plane, node_place(target.mesh, nodes[j]), target.normals.col(nodes[j]));
    image.vertex[k] = {at[0], at[1], local[j][0], local[j][1], gap};
    image.corner[k] = at;
    least = std::min(least, gap);
    largest = std::max(largest, gap);
  }
  image.n = static_cast<int>(n);
  image.target_area = 0.5 * twice_area;
  image.square = 0.0;
  for (std::size_t k = 0; k < n; ++k) {
    const auto &p = image.corner[k], &q = image.corner[(k + 1) % n];
    image.square = std::max(image.square, (q[0] - p[0]) * (q[0] - p[0]) + (q[1] - p[1]) * (q[1] - p[1]));
  }
  const double limit = std::min(gap_limit, near_limit + near_share * (1.0 + sideways_share) * std::sqrt(image.square));
  if (least > limit || largest < -limit) return false;

  const auto& c = image.corner;
  image.is_convex = n == 3 || is_convex(c);
  image.area = 0.5 * turn(c[0], c[1], c[2]) + (n == 4 ? 0.5 * turn(c[0], c[2], c[3]) : 0.0);
  return image.area > piece_tolerance * image.square;
}

/// Local coordinates in the target face of a vertex of a polygon within its image.
PlanePoint target_local(const Image& image, bool is_opposite, const ClipVertex& vertex)
{
  if (image.n == 4 && image.is_convex) {
    const auto [xi, eta] = inverse_bilinear(image.corner, {vertex.x, vertex.y});
    return is_opposite ? PlanePoint{eta, xi} : PlanePoint{xi, eta}; // turned round, the corners are 0, 3, 2, 1
  }
  return {std::clamp(vertex.xi, 0.0, 1.0), std::clamp(vertex.eta, 0.0, 1.0)};
}

/// The image as one convex polygon, or as two triangles along the diagonal that lies inside.
int convex_polygons(const Image& image, std::array<ClipPolygon, 2>& polygons)
{
  const auto set = [&](ClipPolygon& polygon, std::initializer_list<std::size_t> corners) {
    polygon.n = 0;
    for (const auto k : corners) polygon.vertices[static_cast<std::size_t>(polygon.n++)] = image.vertex[k];
  };
  if (image.n == 3) return set(polygons[0], {0, 1, 2}), 1;
  if (image.is_convex) return set(polygons[0], {0, 1, 2, 3}), 1;
  if (is_cut_from_1_to_3(image.corner)) {
    set(polygons[0], {1, 2, 3});
    set(polygons[1], {1, 3, 0});
  } else {
    set(polygons[0], {0, 1, 2});
    set(polygons[1], {0, 2, 3});
  }
  return 2;
}

/// Whether most of a sample of the source's area faces against what is closest to it.
bool normals_are_opposite(const SurfaceMesh& source, const Target& target)
{
  const std::int64_t n = source.n_faces(), stride = std::max<std::int64_t>(1, n / 500);
  double sum = 0.0;
  for (std::int64_t f = 0; f < n; f += stride) {
    const Point centre = face_centre(source, f);
    const auto closest = target.tree.closest(centre, [&](std::int32_t t) {
      const double distance = closest_on_face(target.mesh, t, centre).distance;
      return distance * distance;
    });
    if (closest >= 0)
      sum += twice_area_vector(source, static_cast<std::int32_t>(f)).dot(face_normal(target.mesh, closest));
  }
  return sum < 0.0;
}

BoxTree tree_of(const SurfaceMesh& mesh, const std::vector<std::int32_t>& degenerate)
{
  std::vector<BoxTree::Box> boxes;
  std::vector<std::int32_t> numbers;
  boxes.reserve(static_cast<std::size_t>(mesh.n_faces()));
  numbers.reserve(static_cast<std::size_t>(mesh.n_faces()));
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f) {
    if (std::binary_search(degenerate.begin(), degenerate.end(), f)) continue;
    const auto nodes = mesh.face(f);
    BoxTree::Box box{node_place(mesh, nodes[0]), node_place(mesh, nodes[0])};
    for (const auto node : nodes) {
      box.lo = box.lo.cwiseMin(node_place(mesh, node));
      box.hi = box.hi.cwiseMax(node_place(mesh, node));
    }
    const Point normal = twice_area_vector(mesh, f).normalized();
    const Point reach = near_share * longest_edge(mesh, f) * (normal.cwiseAbs().array() + sideways_share).matrix();
    boxes.push_back({box.lo - reach, box.hi + reach});
    numbers.push_back(f);
  }
  return {std::move(boxes), std::move(numbers)};
}

/// Overlays one source face after the other; keeps its buffers, so that a face needs no memory of its own.
class Overlay {
public:
  Overlay(const SurfaceMesh& source, const Target& target, double gap_tolerance)
      : source_(source), target_(target), gap_tolerance_(gap_tolerance),
        is_reached_(static_cast<std::size_t>(target.mesh.n_nodes()), 0)
  {
  }

  /// The pieces of a source face; returns its coverage. Looks farther as long as the face is not covered, and keeps
  /// what covers it best: what lies near is not mixed with another layer behind it.
  double overlay(std::int32_t f, const PlaneFace& face)
  {
    double best_reach = near_share * face.length, reach = best_reach;
    double best = search(f, face, reach), coverage = best;
    while (coverage < full_coverage && reach < gap_tolerance_) {
      reach = std::min(wider * reach, gap_tolerance_);
      coverage = search(f, face, reach);
      if (std::abs(coverage - 1.0) < std::abs(best - 1.0)) {
        best = coverage;
        best_reach = reach;
      }
    }
    return best_reach == reach ? coverage : search(f, face, best_reach);
  }

  /// What the last call of overlay() found.
  [[nodiscard]] const std::vector<Subelement>& pieces() const { return pieces_; }

  /// Count the pieces of overlay() in. @return their largest gap [m]
  double accept()
  {
    target_area_ += target_area_of_face_;
    for (const auto& piece : pieces_)
      for (const auto node : target_.mesh.face(piece.target_face)) is_reached_[static_cast<std::size_t>(node)] = 1;
    return gap_of_face_;
  }
  [[nodiscard]] double target_area() const { return target_area_; }
  [[nodiscard]] const std::vector<std::uint8_t>& is_reached() const { return is_reached_; }

private:
  double search(std::int32_t f, const PlaneFace& face, double reach)
  {
    pieces_.clear();
    gap_of_face_ = target_area_of_face_ = 0.0;
    Point leaning = Point::Zero();
    double area = 0.0, covered = 0.0;
    for (int p = 0; p < face.n_parts; ++p) {
      const FacePart& part = face.parts[static_cast<std::size_t>(p)];
      leaning = leaning.cwiseMax(part.frame.normal.cwiseAbs());
      area += part.area;
    }
    const Point margin = reach * (leaning.array() + sideways_share).matrix();
    candidates_.clear();
    target_.tree.for_each_in_box(face.lo - margin, face.hi + margin, [&](std::int32_t t) { candidates_.push_back(t); });
    std::sort(candidates_.begin(), candidates_.end());

    for (const auto t : candidates_)
      for (int p = 0; p < face.n_parts; ++p) {
        const FacePart& part = face.parts[static_cast<std::size_t>(p)];
        Image image;
        if (!find_image(target_, t, part.frame, (1.0 + sideways_share) * reach, gap_tolerance_, image)) continue;
        const double square = std::min(face.length * face.length, image.square);
        std::array<ClipPolygon, 2> polygons;
        const int n = convex_polygons(image, polygons);
        for (int i = 0; i < n; ++i) covered += cut(f, t, part, image, square, polygons[static_cast<std::size_t>(i)]);
      }
    return covered / area;
  }

  /// The piece that a polygon of the image and a part of the source face have in common; returns its area.
  double cut(std::int32_t f, std::int32_t t, const FacePart& part, const Image& image, double square,
             ClipPolygon& polygon)
  {
    for (int k = 0; k < part.n && polygon.n > 0; ++k) clip(polygon, part.inside[static_cast<std::size_t>(k)]);
    if (polygon.n < 3) return 0.0;
    const double area = signed_area(polygon);
    if (!(area >= piece_tolerance * square)) return 0.0;
    simplify(polygon, vertex_tolerance * std::sqrt(square), 8);

    Subelement& piece = pieces_.emplace_back();
    piece.source_face = f;
    piece.target_face = t;
    piece.n_vertices = polygon.n;
    for (int v = 0; v < polygon.n; ++v) {
      const ClipVertex& vertex = polygon.vertices[static_cast<std::size_t>(v)];
      const auto in_source = local_coordinates(part, {vertex.x, vertex.y});
      const auto in_target = target_local(image, target_.is_opposite, vertex);
      for (std::size_t c = 0; c < 2; ++c) {
        piece.source_xi[v][c] = in_source[c];
        piece.target_xi[v][c] = in_target[c];
      }
      gap_of_face_ = std::max(gap_of_face_, std::abs(vertex.gap));
    }
    target_area_of_face_ += area / image.area * image.target_area;
    return area;
  }

  const SurfaceMesh& source_;
  const Target& target_;
  double gap_tolerance_;
  std::vector<std::int32_t> candidates_;
  std::vector<Subelement> pieces_;
  double gap_of_face_ = 0.0, target_area_of_face_ = 0.0;
  double target_area_ = 0.0;
  std::vector<std::uint8_t> is_reached_;
};

} // namespace

OverlayReport overlay_surfaces(const SurfaceMesh& source, const SurfaceMesh& target,
                               const SurfaceOverlayOptions& options, const SubelementSink& sink)
{
  OverlayReport report;
  const auto degenerate_source = degenerate_faces(source), degenerate_target = degenerate_faces(target);
  for (const auto t : degenerate_target) report.skipped_target_faces.add(t);
  Target side{target, nodal_normals(target), tree_of(target, degenerate_target)};
  side.is_opposite = options.opposite.value_or(false);
  if (!options.opposite) side.is_opposite = normals_are_opposite(source, side);
  report.is_opposite = side.is_opposite;
  const double gap_tolerance = options.gap_tolerance > 0.0
                                   ? options.gap_tolerance
                                   : 2.0 * std::max(mean_face_size(source), mean_face_size(target));

  const bool has_quadrilaterals = static_cast<std::int64_t>(source.face_nodes.size()) != 3 * source.n_faces();
  const Eigen::Matrix3Xd source_normals = has_quadrilaterals ? nodal_normals(source) : Eigen::Matrix3Xd();

  Overlay overlay(source, side, gap_tolerance);
  double area = 0.0, covered_area = 0.0, target_area = 0.0;
  bool is_first = true;
  report.fit.resize(static_cast<std::size_t>(source.n_faces()));
  for (std::int32_t f = 0; f < source.n_faces(); ++f) {
    const bool is_degenerate = std::binary_search(degenerate_source.begin(), degenerate_source.end(), f);
    const PlaneFace face = is_degenerate ? PlaneFace{} : plane_face(source, f, source_normals);
    if (face.n_parts == 0) {
      report.skipped_source_faces.add(f);
      continue;
    }
    const double own_area = 0.5 * twice_area_vector(source, f).norm();
    double coverage = overlay.overlay(f, face);
    auto& fit = report.fit[static_cast<std::size_t>(f)];
    if (coverage < least_coverage) {
      coverage = 0.0;
      report.uncovered_faces.add(f);
    } else {
      if (coverage < full_coverage) report.partly_covered_faces.add(f);
      fit.gap = overlay.accept();
      report.largest_gap = std::max(report.largest_gap, fit.gap);
      for (const auto& piece : overlay.pieces()) sink(piece);
    }
    fit.coverage = coverage;
    report.min_coverage = is_first ? coverage : std::min(report.min_coverage, coverage);
    report.max_coverage = is_first ? coverage : std::max(report.max_coverage, coverage);
    is_first = false;
    area += own_area;
    covered_area += std::min(coverage, 1.0) * own_area;
  }

  for (std::int32_t t = 0; t < target.n_faces(); ++t) target_area += 0.5 * twice_area_vector(target, t).norm();
  report.covered_fraction = area > 0.0 ? covered_area / area : 0.0;
  report.target_covered_fraction = target_area > 0.0 ? overlay.target_area() / target_area : 0.0;
  for (std::int32_t i = 0; i < target.n_nodes(); ++i)
    if (overlay.is_reached()[static_cast<std::size_t>(i)] == 0) report.unmatched_target_nodes.add(i);
  return report;
}

} // namespace mullion::surface
