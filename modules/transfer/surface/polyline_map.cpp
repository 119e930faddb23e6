#include "polyline_map.hpp"

#include "aabb_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mullion::surface {

namespace {

constexpr double snap = 1e-10;       // of a face: closer places are one
constexpr double edge_slack = 1e-9;  // of a face: by how much a hit may lie outside of it
constexpr double reach_factor = 3.0; // a hit further away than this times the closest point belongs elsewhere
constexpr double reach_slack = 1e-6; // of a mean face, for surfaces that touch
constexpr double nowhere = -1.0;

double cross(const Point& a, const Point& b) { return a.x() * b.y() - a.y() * b.x(); }

double snapped(double place)
{
  const double node = std::round(place);
  return std::abs(place - node) < snap ? node : place;
}

Point right_normal(const Point& a, const Point& b)
{
  const Point d = b - a;
  const double length = d.norm();
  return length > 0.0 ? Point(d.y() / length, -d.x() / length, 0.0) : Point::Zero();
}

double squared_distance_to_face(const Path& path, std::size_t k, const Point& x)
{
  const Point d = path.x[k + 1] - path.x[k];
  const double dd = d.squaredNorm();
  const double xi = dd > 0.0 ? std::clamp((x - path.x[k]).dot(d) / dd, 0.0, 1.0) : 0.0;
  return (path.x[k] + xi * d - x).squaredNorm();
}

/// A path with a tree over its faces.
class PathSearch {
public:
  explicit PathSearch(const Path& path) : path_(path)
  {
    std::vector<BoxTree::Box> boxes;
    std::vector<std::int32_t> numbers;
    for (std::size_t k = 0; k < path.n_faces(); ++k) {
      boxes.push_back({path.x[k].cwiseMin(path.x[k + 1]), path.x[k].cwiseMax(path.x[k + 1])});
      numbers.push_back(static_cast<std::int32_t>(k));
    }
    slack_ = reach_slack * path.arc.back() / static_cast<double>(path.n_faces());
    tree_ = BoxTree(std::move(boxes), std::move(numbers));
  }

  /// The place closest to x, by Euclid.
  [[nodiscard]] double closest(const Point& x) const
  {
    const auto k = static_cast<std::size_t>(closest_face(x));
    const Point d = path_.x[k + 1] - path_.x[k];
    const double dd = d.squaredNorm();
    return static_cast<double>(k) + (dd > 0.0 ? std::clamp((x - path_.x[k]).dot(d) / dd, 0.0, 1.0) : 0.0);
  }

  /// The hit with the smallest distance to x; hits(k, consider) calls consider(xi) for those of face k.
  template <typename Hits> double nearest_hit(const Point& x, double from, double to, Hits hits) const
  {
    const auto near = static_cast<std::size_t>(closest_face(x));
    const double reach = reach_factor * std::sqrt(squared_distance_to_face(path_, near, x)) + slack_;
    double best = nowhere, best_distance = std::numeric_limits<double>::infinity();
    tree_.for_each_in_box(x.array() - reach, x.array() + reach, [&](std::int32_t number) {
      const auto k = static_cast<std::size_t>(number);
      hits(k, [&](double xi) {
        if (!(xi >= -edge_slack && xi <= 1.0 + edge_slack)) return;
        const double place = snapped(static_cast<double>(k) + std::clamp(xi, 0.0, 1.0));
        if (place < from - edge_slack || place > to + edge_slack) return;
        const double distance = (path_.x[k] + xi * (path_.x[k + 1] - path_.x[k]) - x).norm();
        if (distance > reach) return;
        const bool is_better = distance < best_distance || (distance == best_distance && place < best);
        if (is_better) best = place, best_distance = distance;
      });
    });
    return best == nowhere ? nowhere : std::clamp(best, from, to);
  }

private:
  [[nodiscard]] std::int32_t closest_face(const Point& x) const
  {
    return tree_.closest(
        x, [&](std::int32_t k) { return squared_distance_to_face(path_, static_cast<std::size_t>(k), x); });
  }

  const Path& path_;
  BoxTree tree_;
  double slack_ = 0.0; // [m]
};

/// Where a source node lands on the target, along the target's interpolated normals.
double land(const Path& target, const PathSearch& search, const Point& p, const Point& normal, double from, double to)
{
  return search.nearest_hit(p, from, to, [&](std::size_t k, auto consider) {
    const Point d = target.x[k + 1] - target.x[k];
    const Point &n1 = target.normals[k], &n2 = target.normals[k + 1];
    const Point r = p - target.x[k], dn = n2 - n1;
    const double a = -cross(d, dn), b = cross(r, dn) - cross(d, n1), c = cross(r, n1);
    const double discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return;
    const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
    if (q == 0.0) return;                  // a face without length, or a place where all lines meet
    for (const double xi : {c / q, q / a}) // a = 0: the second is infinite, and none
      if (std::isfinite(xi) && normal.dot(n1 + xi * dn) > 0.0) consider(xi);
  });
}

/// Where the line through a target node along its normal meets the source.
double meet(const Path& source, const PathSearch& search, const Point& q, const Point& normal)
{
  return search.nearest_hit(q, 0.0, static_cast<double>(source.n_faces()), [&](std::size_t k, auto consider) {
    const Point d = source.x[k + 1] - source.x[k];
    const double across = cross(d, normal);
    const bool faces_away = right_normal(source.x[k], source.x[k + 1]).dot(normal) <= 0.0;
    if (faces_away || !(std::abs(across) > 1e-12 * d.norm())) return;
    consider(cross(q - source.x[k], normal) / across);
  });
}

/// The longest subsequence whose target does not decrease (the source does not already). O(n log n).
std::vector<Breakpoint> longest_in_order(const std::vector<Breakpoint>& points)
{
  std::vector<std::size_t> tails, before(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto place = std::upper_bound(tails.begin(), tails.end(), points[i].target,
                                        [&](double t, std::size_t j) { return t < points[j].target; });
    before[i] = place == tails.begin() ? points.size() : *(place - 1);
    if (place == tails.end()) tails.push_back(i);
    else *place = i;
  }
  std::vector<Breakpoint> kept;
  if (tails.empty()) return kept;
  for (std::size_t i = tails.back(); i < points.size(); i = before[i]) kept.push_back(points[i]);
  std::reverse(kept.begin(), kept.end());
  return kept;
}

double length_up_to(const Path& path, double place)
{
  const auto k = std::min(static_cast<std::size_t>(place), path.n_faces() - 1);
  const double xi = place - static_cast<double>(k);
  return (1.0 - xi) * path.arc[k] + xi * path.arc[k + 1];
}

double place_at_length(const Path& path, double length)
{
  const auto above = std::upper_bound(path.arc.begin(), path.arc.end(), length);
  const auto k =
      std::clamp<std::ptrdiff_t>(above - path.arc.begin() - 1, 0, static_cast<std::ptrdiff_t>(path.n_faces()) - 1);
  const double begin = path.arc[static_cast<std::size_t>(k)], end = path.arc[static_cast<std::size_t>(k) + 1];
  const double xi = end > begin ? std::clamp((length - begin) / (end - begin), 0.0, 1.0) : 0.0;
  return snapped(static_cast<double>(k) + xi);
}

/// Adds the nodes of either side that lie between two breakpoints, spaced as their lengths are.
void fill_between(const Path& source, const Path& target, const Breakpoint& a, const Breakpoint& b, PathMap& map)
{
  struct Node {
    double share;
    Breakpoint point;
  };
  std::vector<Node> nodes;
  const auto add = [&](const Path& own, const Path& other, double from, double to, double other_from, double other_to,
                       bool is_source) {
    const double begin = length_up_to(own, from), length = length_up_to(own, to) - begin;
    const double other_begin = length_up_to(other, other_from);
    const double other_length = length_up_to(other, other_to) - other_begin;
    for (double node = std::floor(from) + 1.0; node < to; node += 1.0) {
      const double share = length > 0.0 ? (length_up_to(own, node) - begin) / length : 0.0;
      const double place = std::clamp(place_at_length(other, other_begin + share * other_length), other_from, other_to);
      nodes.push_back({share, is_source ? Breakpoint{node, place} : Breakpoint{place, node}});
      auto& missed = is_source ? map.missed_source : map.missed_target;
      missed.push_back(static_cast<std::size_t>(node));
    }
  };
  add(source, target, a.source, b.source, a.target, b.target, true);
  add(target, source, a.target, b.target, a.source, b.source, false);
  std::stable_sort(nodes.begin(), nodes.end(), [](const Node& m, const Node& n) { return m.share < n.share; });
  for (const auto& node : nodes) map.points.push_back(node.point);
}

} // namespace

Path path_along(const SurfaceMesh& mesh, const Chain& chain, bool is_reversed, std::size_t first, std::size_t n_faces)
{
  const std::size_t n = chain.faces.size();
  const auto face = [&](std::size_t i) { return chain.faces[is_reversed ? n - 1 - i % n : i % n]; };
  const auto node = [&](std::size_t i) {
    const std::size_t j = chain.is_loop ? i % n : i;
    return chain.nodes[is_reversed ? n - j : j];
  };
  const auto normal_of = [&](std::size_t i) {
    return right_normal(node_position(mesh, node(i % n)), node_position(mesh, node(i % n + 1)));
  };
  Path path;
  path.is_reversed = is_reversed;
  double length = 0.0;
  for (std::size_t i = first; i <= first + n_faces; ++i) {
    path.nodes.push_back(node(i));
    path.x.push_back(node_position(mesh, node(i)));
    if (i > first) length += (path.x.back() - path.x[path.x.size() - 2]).norm();
    path.arc.push_back(length);
    if (i < first + n_faces) path.faces.push_back(face(i));

    Point sum = Point::Zero();
    if (chain.is_loop || i > 0) sum += normal_of((i + n - 1) % n);
    if (chain.is_loop || i < n) sum += normal_of(i % n);
    const double size = sum.norm();
    path.normals.push_back(size > 0.0 ? Point(sum / size) : Point::Zero());
  }
  return path;
}

Point point_at(const Path& path, double place)
{
  const auto k = std::min(static_cast<std::size_t>(place), path.n_faces() - 1);
  const double xi = place - static_cast<double>(k);
  return (1.0 - xi) * path.x[k] + xi * path.x[k + 1];
}

double local_coordinate(const Path& path, std::size_t position, double place)
{
  const double xi = std::clamp(place - static_cast<double>(position), 0.0, 1.0);
  return path.is_reversed ? 1.0 - xi : xi;
}

double land_on_path(const Path& target, const Point& x, const Point& normal)
{
  return land(target, PathSearch(target), x, normal, 0.0, static_cast<double>(target.n_faces()));
}

PathMap map_paths(const Path& source, const Path& target, const PathEnds& ends)
{
  const PathSearch on_source(source), on_target(target);
  const double from = ends.target_start, to = ends.target_end;
  const auto n_source = static_cast<double>(source.n_faces());
  std::vector<Breakpoint> points;

  if (ends.start_is_same) points.push_back({0.0, from});
  if (ends.end_is_same) points.push_back({n_source, to});
  for (std::size_t i = 0; i <= source.n_faces(); ++i) {
    const bool is_given = (ends.start_is_same && i == 0) || (ends.end_is_same && i == source.n_faces());
    if (is_given) continue;
    const double place = land(target, on_target, source.x[i], source.normals[i], from, to);
    if (place != nowhere) points.push_back({static_cast<double>(i), place});
  }
  for (std::size_t j = 0; j <= target.n_faces(); ++j) {
    const auto place = static_cast<double>(j);
    const bool is_given = (ends.start_is_same && place <= from) || (ends.end_is_same && place >= to);
    if (is_given || place < from || place > to) continue;
    const double met = meet(source, on_source, target.x[j], target.normals[j]);
    if (met != nowhere) points.push_back({met, place});
  }
  if (points.empty()) // nothing faces anything: the closest points, so that the force arrives somewhere
    for (std::size_t i = 0; i <= source.n_faces(); ++i)
      points.push_back({static_cast<double>(i), std::clamp(snapped(on_target.closest(source.x[i])), from, to)});

  std::sort(points.begin(), points.end(), [](const Breakpoint& a, const Breakpoint& b) {
    return std::pair(a.source, a.target) < std::pair(b.source, b.target);
  });
  const auto kept = longest_in_order(points);

  PathMap map;
  map.covered_from = kept.front().source;
  map.covered_to = kept.back().source;
  Breakpoint last = {0.0, kept.front().target};
  map.points.push_back(last);
  const auto go_to = [&](const Breakpoint& next) {
    fill_between(source, target, last, next, map);
    if (next.source != last.source || next.target != last.target) map.points.push_back(next);
    last = next;
  };
  for (const auto& point : kept) go_to(point);
  go_to({n_source, kept.back().target});
  if (map.covered_from > 0.0) map.missed_source.push_back(0);
  if (map.covered_to < n_source) map.missed_source.push_back(source.n_faces());
  std::sort(map.missed_source.begin(), map.missed_source.end());
  return map;
}

} // namespace mullion::surface
