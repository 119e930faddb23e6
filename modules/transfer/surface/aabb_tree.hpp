// Which faces lie near a place: a static tree of axis-aligned boxes, built once per mesh, asked for all faces in a box
// and for the closest point of the surface. What it answers does not depend on how the tree is cut: ties go to the
// smaller number.
#pragma once

#include "surface_mesh.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace mullion::surface {

/// Axis-aligned boxes in a binary tree, halved by number along the longest side of their centres.
class BoxTree {
public:
  struct Box {
    Point lo, hi; ///< [m]
  };

  BoxTree() = default;

  /// @param boxes    one an item
  /// @param numbers  of the items, as queries report them
  BoxTree(std::vector<Box> boxes, std::vector<std::int32_t> numbers);

  /// Calls visit(number) for every item whose box touches [lo, hi], in an order that depends on the boxes alone.
  template <typename Visit> void for_each_in_box(const Point& lo, const Point& hi, Visit visit) const
  {
    if (nodes_.empty()) return;
    std::vector<std::int32_t> stack = {0};
    while (!stack.empty()) {
      const Node& node = nodes_[static_cast<std::size_t>(stack.back())];
      stack.pop_back();
      if (!touch(node.box, lo, hi)) continue;
      if (node.n_items == 0) {
        stack.push_back(node.second);
        stack.push_back(node.first);
      } else
        for (std::int32_t i = node.first; i < node.first + node.n_items; ++i)
          if (touch(boxes_[static_cast<std::size_t>(i)], lo, hi)) visit(numbers_[static_cast<std::size_t>(i)]);
    }
  }

  /// The item with the smallest squared_distance(number) [m^2]; ties go to the smaller number. -1 in an empty tree.
  ///
  /// @pre  no item is closer to x than its box
  template <typename SquaredDistance> std::int32_t closest(const Point& x, SquaredDistance squared_distance) const
  {
    constexpr double reach = 1.0 + 1e-12; // a tie must not depend on the round-off of a box's distance
    std::int32_t best = -1;
    double best_distance = std::numeric_limits<double>::infinity();
    if (nodes_.empty()) return best;
    std::vector<std::pair<double, std::int32_t>> stack = {{0.0, 0}}; // distance of the node's box, node
    while (!stack.empty()) {
      const auto [bound, number] = stack.back();
      stack.pop_back();
      if (bound > reach * best_distance) continue; // equal ones may hold a smaller number
      const Node& node = nodes_[static_cast<std::size_t>(number)];
      if (node.n_items == 0) {
        const double first = distance(nodes_[static_cast<std::size_t>(node.first)].box, x);
        const double second = distance(nodes_[static_cast<std::size_t>(node.second)].box, x);
        const bool first_is_nearer = first <= second;
        stack.push_back(first_is_nearer ? std::pair(second, node.second) : std::pair(first, node.first));
        stack.push_back(first_is_nearer ? std::pair(first, node.first) : std::pair(second, node.second));
        continue;
      }
      for (std::int32_t i = node.first; i < node.first + node.n_items; ++i) {
        if (distance(boxes_[static_cast<std::size_t>(i)], x) > reach * best_distance) continue;
        const auto item = numbers_[static_cast<std::size_t>(i)];
        const double d = squared_distance(item);
        if (d < best_distance || (d == best_distance && item < best)) best_distance = d, best = item;
      }
    }
    return best;
  }

private:
  struct Node {
    Box box;
    std::int32_t first = 0;   ///< child, or first item
    std::int32_t second = 0;  ///< child
    std::int32_t n_items = 0; ///< 0: an inner node
  };

  static bool touch(const Box& box, const Point& lo, const Point& hi)
  {
    return (box.lo.array() <= hi.array()).all() && (lo.array() <= box.hi.array()).all();
  }
  static double distance(const Box& box, const Point& x) // squared
  {
    return (box.lo - x).cwiseMax(x - box.hi).cwiseMax(0.0).squaredNorm();
  }

  std::vector<Node> nodes_; // the root first
  std::vector<Box> boxes_;  // of the items, leaf by leaf
  std::vector<std::int32_t> numbers_;
};

/// The closest point of a surface.
struct Closest {
  std::int32_t face = -1; ///< -1: there is no face
  double xi[2] = {};      ///< local coordinates within it
  double distance = 0.0;  ///< [m]
};

/// Closest point of one face: a line, a triangle by its Voronoi regions (Ericson 2004, section 5.1.5), a quadrilateral
/// as the bilinear surface (the nearer of its two triangles, then Newton, or the nearest edge).
[[nodiscard]] Closest closest_on_face(const SurfaceMesh& mesh, std::int64_t f, const Point& x);

/// The faces of a mesh, without the degenerate ones, in a tree. Keeps a reference to the mesh.
class FaceTree {
public:
  /// @param inflate  by how much each face's box is larger than the face, on all sides [m]
  explicit FaceTree(const SurfaceMesh& mesh, double inflate = 0.0);

  /// Calls visit(face) for every face whose inflated box touches [lo, hi]; not in ascending order.
  template <typename Visit> void for_each_in_box(const Point& lo, const Point& hi, Visit visit) const
  {
    tree_.for_each_in_box(lo, hi, visit);
  }

  /// The closest point of the surface; among equally close faces the one with the smallest number.
  [[nodiscard]] Closest closest(const Point& x) const;

private:
  const SurfaceMesh* mesh_;
  BoxTree tree_;
};

/// The nodes of a mesh in a tree.
class NodeTree {
public:
  explicit NodeTree(const SurfaceMesh& mesh);

  /// The closest node; among equally close ones the smallest number. -1 without nodes.
  [[nodiscard]] std::int32_t closest(const Point& x) const;

private:
  const SurfaceMesh* mesh_;
  BoxTree tree_;
};

/// Whether the normals of two sides point against each other: weighed by measure, over the source's faces, each with
/// the target face that is closest to its centre.
[[nodiscard]] bool normals_oppose(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree);

} // namespace mullion::surface
