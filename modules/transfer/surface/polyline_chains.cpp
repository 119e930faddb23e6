#include "polyline_chains.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mullion::surface {

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// Mean length of the faces around a node [m].
double size_at(const SurfaceMesh& mesh, const PolylineNodes& nodes, std::int32_t node)
{
  double sum = 0.0;
  int n = 0;
  for (const auto face : {nodes.previous_face[index(node)], nodes.next_face[index(node)]})
    if (face >= 0) sum += face_measure(mesh, face), ++n;
  return n == 0 ? 0.0 : sum / n;
}

std::int32_t nearest_feature(const SurfaceMesh& mesh, const PolylineNodes& nodes, const Point& x)
{
  std::int32_t best = -1;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const auto node : nodes.features) {
    const double d = (node_position(mesh, node) - x).squaredNorm();
    if (d < best_distance) best = node, best_distance = d;
  }
  return best;
}

} // namespace

PolylineNodes polyline_nodes(const SurfaceMesh& mesh, double feature_angle)
{
  const auto n = static_cast<std::size_t>(mesh.n_nodes());
  PolylineNodes result{std::vector<std::int32_t>(n, -1), std::vector<std::int32_t>(n, -1), std::vector<bool>(n), {}};
  std::vector<int> n_begins(n, 0), n_ends(n, 0);
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f) {
    const auto face = mesh.face(f);
    result.next_face[index(face[0])] = f;
    result.previous_face[index(face[1])] = f;
    ++n_begins[index(face[0])];
    ++n_ends[index(face[1])];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (n_begins[i] + n_ends[i] == 0) continue; // a node of no face
    result.is_passage[i] = n_begins[i] == 1 && n_ends[i] == 1;
    bool is_feature = !result.is_passage[i];
    if (!is_feature) {
      const Point before = face_normal(mesh, result.previous_face[i]);
      const Point after = face_normal(mesh, result.next_face[i]);
      // A face without length has no direction: no corner is seen there.
      is_feature = !before.isZero() && !after.isZero() &&
                   std::atan2(before.cross(after).norm(), before.dot(after)) > feature_angle;
    }
    if (is_feature) result.features.push_back(static_cast<std::int32_t>(i));
  }
  return result;
}

std::vector<std::int32_t> match_features(const SurfaceMesh& source, const PolylineNodes& source_nodes,
                                         const SurfaceMesh& target, const PolylineNodes& target_nodes, double tolerance)
{
  std::vector<std::int32_t> match(static_cast<std::size_t>(source.n_nodes()), -1);
  for (const auto s : source_nodes.features) {
    const auto t = nearest_feature(target, target_nodes, node_position(source, s));
    if (t < 0 || nearest_feature(source, source_nodes, node_position(target, t)) != s) continue;
    const double h = std::max(size_at(source, source_nodes, s), size_at(target, target_nodes, t));
    if ((node_position(source, s) - node_position(target, t)).norm() <= tolerance * h) match[index(s)] = t;
  }
  return match;
}

std::vector<Chain> chains_of(const SurfaceMesh& mesh, const PolylineNodes& nodes, const std::vector<bool>& is_cut)
{
  std::vector<bool> is_done(static_cast<std::size_t>(mesh.n_faces()), false);
  const auto goes_on = [&](std::int32_t node) { return nodes.is_passage[index(node)] && !is_cut[index(node)]; };

  const auto follow = [&](std::int32_t first) {
    Chain chain;
    chain.nodes.push_back(mesh.face(first)[0]);
    for (std::int32_t f = first; f >= 0 && !is_done[index(f)];) {
      is_done[index(f)] = true;
      chain.faces.push_back(f);
      const auto end = mesh.face(f)[1];
      chain.nodes.push_back(end);
      f = goes_on(end) ? nodes.next_face[index(end)] : -1;
    }
    return chain;
  };

  std::vector<Chain> chains;
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f)
    if (!goes_on(mesh.face(f)[0])) chains.push_back(follow(f));
  for (std::int32_t f = 0; f < mesh.n_faces(); ++f) // what is left has no begin: loops
    if (!is_done[index(f)]) {
      chains.push_back(follow(f));
      chains.back().is_loop = true;
    }
  std::sort(chains.begin(), chains.end(), [](const Chain& a, const Chain& b) {
    return *std::min_element(a.faces.begin(), a.faces.end()) < *std::min_element(b.faces.begin(), b.faces.end());
  });
  return chains;
}

} // namespace mullion::surface
