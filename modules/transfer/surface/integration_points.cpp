#include "integration_points.hpp"

#include "quadrature_rules.hpp"
#include "shape_functions.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <array>
#include <cmath>

namespace mullion::surface {

namespace {

constexpr int largest_order = 64;

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// A corner of a piece, or of a triangle of it, on both sides.
struct Corner {
  double source_xi[2], target_xi[2];
  Point source_x, target_x;
};

Point metric_point(const Corner& c, Metric metric)
{
  if (metric == Metric::source) return c.source_x;
  return metric == Metric::target ? c.target_x : Point(0.5 * (c.source_x + c.target_x));
}

double simplex_measure(std::span<const Corner> c, Metric metric)
{
  const Point a = metric_point(c[0], metric), b = metric_point(c[1], metric);
  if (c.size() == 2) return (b - a).norm();
  return 0.5 * (b - a).cross(metric_point(c[2], metric) - a).norm();
}

/// The mean of corners with weights. In a quadrilateral the mean of places is not at the mean of local coordinates.
Corner weighted(const SurfaceMesh& source, const SurfaceMesh& target, const Subelement& piece,
                std::span<const Corner> corners, const double* weights)
{
  Corner c{{0.0, 0.0}, {0.0, 0.0}, Point::Zero(), Point::Zero()};
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (int i = 0; i < 2; ++i) c.source_xi[i] += weights[k] * corners[k].source_xi[i];
    for (int i = 0; i < 2; ++i) c.target_xi[i] += weights[k] * corners[k].target_xi[i];
    c.source_x += weights[k] * corners[k].source_x;
    c.target_x += weights[k] * corners[k].target_x;
  }
  if (source.face(piece.source_face).size() == 4)
    invert_quadrilateral(source, piece.source_face, c.source_x, c.source_xi);
  if (target.face(piece.target_face).size() == 4)
    invert_quadrilateral(target, piece.target_face, c.target_x, c.target_xi);
  return c;
}

/// Points of one segment or triangle; its measure on the source is returned.
double add_simplex(const SurfaceMesh& source, const SurfaceMesh& target, const Subelement& piece,
                   std::span<const Corner> corners, const Rule& rule, Metric metric,
                   std::vector<IntegrationPoint>& points)
{
  const double measure = simplex_measure(corners, metric);
  if (!(measure > 0.0)) return simplex_measure(corners, Metric::source); // it has a part on the other side only
  const double reference = corners.size() == 2 ? 1.0 : 0.5;              // measure of the rule's simplex
  for (const auto& p : rule) {
    const double a = p.xi[0], b = p.xi[1];
    const std::array<double, 3> weights =
        corners.size() == 2 ? std::array{1.0 - a, a, 0.0} : std::array{1.0 - a - b, a, b};
    const auto c = weighted(source, target, piece, corners, weights.data());
    points.push_back({piece.source_face,
                      piece.target_face,
                      {c.source_xi[0], c.source_xi[1]},
                      {c.target_xi[0], c.target_xi[1]},
                      p.weight / reference * measure});
  }
  return simplex_measure(corners, Metric::source);
}

/// All corners of a piece.
std::vector<Corner> corners_of(const SurfaceMesh& source, const SurfaceMesh& target, const Subelement& piece)
{
  std::vector<Corner> corners;
  for (int k = 0; k < piece.n_vertices; ++k) {
    const double *s = piece.source_xi[k], *t = piece.target_xi[k];
    corners.push_back({{s[0], s[1]},
                       {t[0], t[1]},
                       map_to_space(source, piece.source_face, s),
                       map_to_space(target, piece.target_face, t)});
  }
  return corners;
}

/// Points of one piece; its measure on the source is returned.
double add_piece(const SurfaceMesh& source, const SurfaceMesh& target, const Subelement& piece, const Rule& rule,
                 Metric metric, std::vector<IntegrationPoint>& points)
{
  const auto corners = corners_of(source, target, piece);
  if (corners.size() <= 3) return add_simplex(source, target, piece, corners, rule, metric, points);
  const std::vector<double> equal(corners.size(), 1.0 / static_cast<double>(corners.size()));
  const auto middle = weighted(source, target, piece, corners, equal.data());
  double measure = 0.0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const std::array triangle = {middle, corners[k], corners[(k + 1) % corners.size()]};
    measure += add_simplex(source, target, piece, triangle, rule, metric, points);
  }
  return measure;
}

/// Which target faces have a point, and the loads of a unit traction: sum over the points of w N_j.
struct Reached {
  const SurfaceMesh& target;
  std::vector<bool> has_point = std::vector<bool>(static_cast<std::size_t>(target.n_faces()), false);
  std::vector<double> unit_load = std::vector<double>(static_cast<std::size_t>(target.n_nodes()), 0.0);

  void add(std::span<const IntegrationPoint> points)
  {
    for (const auto& p : points) {
      has_point[index(p.target_face)] = true;
      const auto nodes = target.face(p.target_face);
      const auto n = shape_values(nodes.size(), p.target_xi);
      for (std::size_t k = 0; k < nodes.size(); ++k) unit_load[index(nodes[k])] += p.weight * n[k];
    }
  }
  [[nodiscard]] std::vector<std::int32_t> empty_faces() const
  {
    std::vector<std::int32_t> empty;
    for (std::int32_t f = 0; f < target.n_faces(); ++f)
      if (!has_point[index(f)]) empty.push_back(f);
    return empty;
  }
};

/// Points of all source faces, each face with its own order; only those of one face are kept at a time.
void project(const SurfaceMesh& source, const FaceTree& target_tree, const std::vector<int>& order,
             const PointSink& sink)
{
  std::vector<IntegrationPoint> points;
  for (std::int32_t f = 0; f < source.n_faces(); ++f) {
    points.clear();
    if (add_closest_points(source, target_tree, f, order[index(f)], points)) sink(f, points);
  }
}

Reached reached(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                const std::vector<int>& order)
{
  Reached result{target};
  project(source, target_tree, order, [&](std::int32_t, auto points) { result.add(points); });
  return result;
}

/// Orders of the source faces, see QuadratureOptions.
std::vector<int> orders(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                        const QuadratureOptions& options)
{
  std::vector<int> order(static_cast<std::size_t>(source.n_faces()), options.n_points);
  if (!options.is_adaptive) return order;

  auto found = reached(source, target, target_tree, order);
  const FaceTree source_tree(source);
  for (;;) {
    bool has_changed = false;
    std::vector<bool> is_raised(order.size(), false);
    for (const auto f : found.empty_faces()) {
      const auto beside = source_tree.closest(face_centre(target, f)).face;
      if (beside >= 0 && order[index(beside)] < largest_order) is_raised[index(beside)] = has_changed = true;
    }
    for (std::size_t f = 0; f < order.size(); ++f)
      if (is_raised[f]) order[f] = std::min(2 * order[f], largest_order);
    if (!has_changed) break;
    auto finer = reached(source, target, target_tree, order);
    found.has_point = std::move(finer.has_point), found.unit_load = std::move(finer.unit_load);
  }

  while (options.tolerance > 0.0 && *std::min_element(order.begin(), order.end()) < largest_order) {
    for (auto& n : order) n = std::min(2 * n, largest_order);
    auto finer = reached(source, target, target_tree, order);
    double change = 0.0, largest = 0.0;
    for (std::size_t j = 0; j < finer.unit_load.size(); ++j) {
      change = std::max(change, std::abs(finer.unit_load[j] - found.unit_load[j]));
      largest = std::max(largest, std::abs(finer.unit_load[j]));
    }
    found.unit_load = std::move(finer.unit_load);
    if (change < options.tolerance * largest) break;
  }
  return order;
}

} // namespace

Eigen::Vector4d shape_integrals(const SurfaceMesh& mesh, std::int32_t face)
{
  const auto n = mesh.face(face).size();
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const auto& p : mass_rule(n)) {
    const auto values = shape_values(n, p.xi);
    for (std::size_t k = 0; k < n; ++k)
      sum[static_cast<Eigen::Index>(k)] += p.weight * measure_density(mesh, face, p.xi) * values[k];
  }
  return sum;
}

namespace {

/// Weigh the points of a face that its pieces cover in part so that each shape function keeps its integral, and with it
/// any nodal traction its force: by a linear function over the face. @return false: it would not be positive, or there
/// is nothing to do
bool keep_first_moments(const SurfaceMesh& source, std::int32_t face, std::span<IntegrationPoint> points)
{
  const auto n = static_cast<Eigen::Index>(source.face(face).size());
  const auto values_at = [&](const IntegrationPoint& p) {
    const auto values = shape_values(static_cast<std::size_t>(n), p.source_xi);
    Eigen::Vector4d v = Eigen::Vector4d::Zero();
    for (Eigen::Index k = 0; k < n; ++k) v[k] = values[static_cast<std::size_t>(k)];
    return v;
  };
  Eigen::Matrix4d mass = Eigen::Matrix4d::Zero();
  Eigen::Vector4d covered = Eigen::Vector4d::Zero();
  for (const auto& p : points) {
    const auto v = values_at(p);
    mass += p.weight * v * v.transpose();
    covered += p.weight * v;
  }
  const Eigen::Vector4d own = shape_integrals(source, face);
  if ((covered - own).cwiseAbs().maxCoeff() <= 1e-13 * own.maxCoeff()) return false; // wholly covered
  const Eigen::VectorXd slope = mass.topLeftCorner(n, n).ldlt().solve(own.head(n));
  const auto factor = [&](const IntegrationPoint& p) { return slope.dot(values_at(p).head(n)); };
  if (!std::all_of(points.begin(), points.end(), [&](const auto& p) { return factor(p) > 0.0; })) return false;
  for (auto& p : points) p.weight *= factor(p);
  return true;
}

} // namespace

double add_points_of_face(const SurfaceMesh& source, const SurfaceMesh& target, std::span<const Subelement> pieces,
                          Metric metric, std::vector<IntegrationPoint>& points)
{
  static const Rule six = triangle_rule_of_degree_4();
  const auto face = pieces.front().source_face;
  const std::size_t first_point = points.size();
  double measure = 0.0;
  for (const auto& piece : pieces) {
    const bool has_quadrilateral = source.face(face).size() == 4 || target.face(piece.target_face).size() == 4;
    const auto& rule = piece.n_vertices == 2 ? mass_rule(2) : has_quadrilateral ? six : mass_rule(3);
    measure += add_piece(source, target, piece, rule, metric, points);
  }
  const double own = face_measure(source, face);
  const double coverage = own > 0.0 ? measure / own : 0.0;
  if (!(coverage > 1e-12)) { // nothing that could be scaled
    points.resize(first_point);
    return 0.0;
  }
  if (metric == Metric::target) return coverage;
  const auto own_points = std::span(points).subspan(first_point);
  if (metric == Metric::source && keep_first_moments(source, face, own_points)) return coverage;
  for (auto& point : own_points) point.weight *= own / measure;
  return coverage;
}

PointSet points_of_overlay(const SurfaceMesh& source, const SurfaceMesh& target, std::span<const Subelement> pieces,
                           Metric metric)
{
  PointSet set;
  set.coverage.assign(static_cast<std::size_t>(source.n_faces()), 0.0);
  for (std::size_t begin = 0; begin < pieces.size();) {
    const auto face = pieces[begin].source_face;
    std::size_t end = begin;
    while (end < pieces.size() && pieces[end].source_face == face) ++end;
    set.coverage[index(face)] =
        add_points_of_face(source, target, pieces.subspan(begin, end - begin), metric, set.points);
    begin = end;
  }
  Reached found{target};
  found.add(set.points);
  set.target_empty = found.empty_faces();
  return set;
}

bool add_closest_points(const SurfaceMesh& source, const FaceTree& target_tree, std::int32_t face, int n,
                        std::vector<IntegrationPoint>& points)
{
  double measure = 0.0;
  const std::size_t first_point = points.size();
  const auto n_nodes = source.face(face).size();
  for (const auto& p : n == 2 ? mass_rule(n_nodes) : face_rule(n_nodes, n)) {
    const double weight = p.weight * measure_density(source, face, p.xi);
    const auto closest = target_tree.closest(map_to_space(source, face, p.xi));
    measure += weight;
    points.push_back({face, closest.face, {p.xi[0], p.xi[1]}, {closest.xi[0], closest.xi[1]}, weight});
  }
  if (!(measure > 0.0)) {
    points.resize(first_point);
    return false;
  }
  // Only a rule that is too coarse for a warped quadrilateral differs from the face's own measure.
  const double factor = face_measure(source, face) / measure;
  for (std::size_t i = first_point; i < points.size(); ++i) points[i].weight *= factor;
  return true;
}

void for_each_quadrature_face(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                              const QuadratureOptions& options, const PointSink& sink)
{
  project(source, target_tree, orders(source, target, target_tree, options), sink);
}

PointSet quadrature_points(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                           const QuadratureOptions& options)
{
  PointSet set;
  Reached found{target};
  set.coverage.assign(static_cast<std::size_t>(source.n_faces()), 0.0);
  for_each_quadrature_face(source, target, target_tree, options, [&](std::int32_t face, auto points) {
    set.points.insert(set.points.end(), points.begin(), points.end());
    set.coverage[index(face)] = 1.0;
    found.add(points);
  });
  set.target_empty = found.empty_faces();
  return set;
}

} // namespace mullion::surface
