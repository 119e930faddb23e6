#include "aabb_tree.hpp"

#include "shape_functions.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace mullion::surface {

namespace {

constexpr std::int32_t items_per_leaf = 4;

/// Closest point of the segment a b: its parameter in [0, 1].
double closest_on_segment(const Point& a, const Point& b, const Point& x)
{
  const Point d = b - a;
  const double dd = d.squaredNorm();
  return dd > 0.0 ? std::clamp((x - a).dot(d) / dd, 0.0, 1.0) : 0.0; // a point: any parameter
}

struct Barycentric {
  double b1, b2; ///< of the second and third corner
};

/// Closest point of a triangle: the region of x decides whether it is a corner, on an edge or inside.
Barycentric closest_on_triangle(const Point& a, const Point& b, const Point& c, const Point& x)
{
  const Point ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
  const double d1 = ab.dot(ax), d2 = ac.dot(ax);
  if (d1 <= 0.0 && d2 <= 0.0) return {0.0, 0.0};
  const double d3 = ab.dot(bx), d4 = ac.dot(bx);
  if (d3 >= 0.0 && d4 <= d3) return {1.0, 0.0};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return {d1 > d3 ? d1 / (d1 - d3) : 0.0, 0.0};
  const double d5 = ab.dot(cx), d6 = ac.dot(cx);
  if (d6 >= 0.0 && d5 <= d6) return {0.0, 1.0};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return {0.0, d2 > d6 ? d2 / (d2 - d6) : 0.0};
  const double va = d3 * d6 - d5 * d4;
  const double to_c = d4 - d3, to_b = d5 - d6;
  if (va <= 0.0 && to_c >= 0.0 && to_b >= 0.0) {
    const double w = to_c + to_b > 0.0 ? to_c / (to_c + to_b) : 0.0;
    return {1.0 - w, w};
  }
  const double sum = va + vb + vc;
  if (!(sum > 0.0)) return {0.0, 0.0}; // no area; the regions above have taken all but round-off
  return {vb / sum, vc / sum};
}

Closest with_distance(const SurfaceMesh& mesh, std::int64_t f, double xi, double eta, const Point& x)
{
  Closest closest{static_cast<std::int32_t>(f), {xi, eta}, 0.0};
  closest.distance = (map_to_space(mesh, f, closest.xi) - x).norm();
  return closest;
}

Closest closest_on_quadrilateral(const SurfaceMesh& mesh, std::int64_t f, const Point& x)
{
  const auto nodes = mesh.face(f);
  const auto p = [&](std::size_t k) { return node_position(mesh, nodes[k]); };
  const auto lower = closest_on_triangle(p(0), p(1), p(2), x); // corners (0,0), (1,0), (1,1)
  const auto upper = closest_on_triangle(p(0), p(2), p(3), x); // corners (0,0), (1,1), (0,1)
  const auto from_lower = with_distance(mesh, f, lower.b1 + lower.b2, lower.b2, x);
  const auto from_upper = with_distance(mesh, f, upper.b1, upper.b1 + upper.b2, x);
  Closest best = from_lower.distance <= from_upper.distance ? from_lower : from_upper;

  double xi[2] = {best.xi[0], best.xi[1]};
  invert_quadrilateral(mesh, f, x, xi);
  constexpr double slack = 1e-12; // round-off of the iteration
  if (xi[0] >= -slack && xi[0] <= 1.0 + slack && xi[1] >= -slack && xi[1] <= 1.0 + slack) {
    const auto inside = with_distance(mesh, f, std::clamp(xi[0], 0.0, 1.0), std::clamp(xi[1], 0.0, 1.0), x);
    if (inside.distance <= best.distance) return inside;
  }
  static constexpr double corner[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t l = (k + 1) % 4;
    const double s = closest_on_segment(p(k), p(l), x);
    const auto edge = with_distance(mesh, f, (1.0 - s) * corner[k][0] + s * corner[l][0],
                                    (1.0 - s) * corner[k][1] + s * corner[l][1], x);
    if (edge.distance < best.distance) best = edge;
  }
  return best;
}

BoxTree tree_of_faces(const SurfaceMesh& mesh, double inflate)
{
  const auto skipped = degenerate_faces(mesh);
  std::vector<BoxTree::Box> boxes;
  std::vector<std::int32_t> numbers;
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f) {
    if (std::binary_search(skipped.begin(), skipped.end(), f)) continue;
    BoxTree::Box box{Point::Constant(std::numeric_limits<double>::infinity()),
                     Point::Constant(-std::numeric_limits<double>::infinity())};
    for (const auto node : mesh.face(f)) {
      box.lo = box.lo.cwiseMin(node_position(mesh, node));
      box.hi = box.hi.cwiseMax(node_position(mesh, node));
    }
    box.lo.array() -= inflate;
    box.hi.array() += inflate;
    boxes.push_back(box);
    numbers.push_back(f);
  }
  return {std::move(boxes), std::move(numbers)};
}

} // namespace

BoxTree::BoxTree(std::vector<Box> boxes, std::vector<std::int32_t> numbers)
{
  const auto n = static_cast<std::int32_t>(boxes.size());
  if (n == 0) return;
  std::vector<std::int32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0);
  const auto box = [&](std::int32_t i) -> const Box& { return boxes[static_cast<std::size_t>(i)]; };

  const std::function<std::int32_t(std::int32_t, std::int32_t)> cut = [&](std::int32_t begin, std::int32_t end) {
    const auto number = static_cast<std::int32_t>(nodes_.size());
    nodes_.emplace_back();
    Node node;
    node.box = box(order[static_cast<std::size_t>(begin)]);
    Point lo = node.box.lo + node.box.hi, hi = lo; // of the centres, twice
    for (std::int32_t i = begin + 1; i < end; ++i) {
      const Box& b = box(order[static_cast<std::size_t>(i)]);
      node.box = {node.box.lo.cwiseMin(b.lo), node.box.hi.cwiseMax(b.hi)};
      lo = lo.cwiseMin(b.lo + b.hi);
      hi = hi.cwiseMax(b.lo + b.hi);
    }
    if (end - begin <= items_per_leaf) node.first = begin, node.n_items = end - begin;
    else {
      Eigen::Index axis = 0;
      (hi - lo).maxCoeff(&axis);
      const auto middle = begin + (end - begin) / 2;
      std::nth_element(
          order.begin() + begin, order.begin() + middle, order.begin() + end, [&](std::int32_t i, std::int32_t j) {
            return std::pair(box(i).lo[axis] + box(i).hi[axis], i) < std::pair(box(j).lo[axis] + box(j).hi[axis], j);
          });
      node.first = cut(begin, middle);
      node.second = cut(middle, end);
    }
    nodes_[static_cast<std::size_t>(number)] = node;
    return number;
  };
  cut(0, n);

  for (const auto i : order) {
    boxes_.push_back(box(i));
    numbers_.push_back(numbers[static_cast<std::size_t>(i)]);
  }
}

Closest closest_on_face(const SurfaceMesh& mesh, std::int64_t f, const Point& x)
{
  const auto nodes = mesh.face(f);
  const auto p = [&](std::size_t k) { return node_position(mesh, nodes[k]); };
  if (nodes.size() == 2) return with_distance(mesh, f, closest_on_segment(p(0), p(1), x), 0.0, x);
  if (nodes.size() == 4) return closest_on_quadrilateral(mesh, f, x);
  const auto b = closest_on_triangle(p(0), p(1), p(2), x);
  return with_distance(mesh, f, b.b1, b.b2, x);
}

FaceTree::FaceTree(const SurfaceMesh& mesh, double inflate) : mesh_(&mesh), tree_(tree_of_faces(mesh, inflate)) {}

Closest FaceTree::closest(const Point& x) const
{
  const auto face = tree_.closest(x, [&](std::int32_t f) {
    const double d = closest_on_face(*mesh_, f, x).distance;
    return d * d;
  });
  return face < 0 ? Closest{} : closest_on_face(*mesh_, face, x);
}

NodeTree::NodeTree(const SurfaceMesh& mesh) : mesh_(&mesh)
{
  std::vector<BoxTree::Box> boxes;
  std::vector<std::int32_t> numbers;
  for (std::int32_t i = 0; i < mesh.n_nodes(); ++i) {
    boxes.push_back({node_position(mesh, i), node_position(mesh, i)});
    numbers.push_back(i);
  }
  tree_ = BoxTree(std::move(boxes), std::move(numbers));
}

std::int32_t NodeTree::closest(const Point& x) const
{
  return tree_.closest(x, [&](std::int32_t i) { return (node_position(*mesh_, i) - x).squaredNorm(); });
}

bool normals_oppose(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree)
{
  double sum = 0.0;
  for (std::int64_t f = 0; f < source.n_faces(); ++f) {
    const auto closest = target_tree.closest(face_centre(source, f));
    if (closest.face < 0) continue;
    sum += face_measure(source, f) * face_normal(source, f).dot(face_normal(target, closest.face));
  }
  return sum < 0.0;
}

} // namespace mullion::surface
