#include "polyline_overlay.hpp"

#include "aabb_tree.hpp"
#include "polyline_chains.hpp"
#include "polyline_map.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace mullion::surface {

namespace {

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

/// What is known of both sides while their chains are put together.
struct Sides {
  const SurfaceMesh& source;
  const SurfaceMesh& target;
  FaceTree target_tree;
  std::vector<Chain> source_chains, target_chains;
  std::vector<std::size_t> chain_of_target_face;
  std::vector<std::int32_t> match; ///< of source nodes: the target node that is the same feature, or -1
  std::optional<bool> is_opposite; ///< if the caller knows
};

/// Pieces and lists as they are collected, in no order yet.
struct Collected {
  std::vector<Subelement> pieces;
  std::vector<FaceFit> fit;           ///< of each source face; coverage is the share with a counterpart
  std::vector<double> target_covered; ///< of each target face: share that a source reaches
  std::vector<std::int32_t> missed_source, missed_target;
};

constexpr double negligible_share = 1e-6; // of a face: an end that is missed by less is round-off of the meshes

/// Whether the chain has to be walked against the target's: by the votes of the source's faces.
bool runs_against(const Sides& sides, const std::vector<std::int32_t>& faces)
{
  if (sides.is_opposite) return *sides.is_opposite;
  double sum = 0.0;
  for (const auto f : faces) {
    const auto closest = sides.target_tree.closest(face_centre(sides.source, f));
    if (closest.face >= 0)
      sum += face_measure(sides.source, f) * face_normal(sides.source, f).dot(face_normal(sides.target, closest.face));
  }
  return sum < 0.0;
}

/// Pieces, coverage and lists of one pair of paths.
void collect(const Path& source, const Path& target, const PathEnds& ends, Collected& out)
{
  const auto map = map_paths(source, target, ends);
  const auto position_of = [](const Path& path, double from, double to) {
    const auto k = static_cast<std::size_t>(0.5 * (from + to));
    return std::min(k, path.n_faces() - 1);
  };
  for (std::size_t i = 0; i + 1 < map.points.size(); ++i) {
    const auto &a = map.points[i], &b = map.points[i + 1];
    const double source_share = b.source - a.source, target_share = b.target - a.target;
    if (!(source_share > 0.0) && !(target_share > 0.0)) continue;
    const auto k = position_of(source, a.source, b.source), l = position_of(target, a.target, b.target);
    Subelement piece;
    piece.source_face = source.faces[k];
    piece.target_face = target.faces[l];
    piece.n_vertices = 2;
    piece.source_xi[0][0] = local_coordinate(source, k, a.source);
    piece.source_xi[1][0] = local_coordinate(source, k, b.source);
    piece.target_xi[0][0] = local_coordinate(target, l, a.target);
    piece.target_xi[1][0] = local_coordinate(target, l, b.target);
    out.pieces.push_back(piece);

    const bool is_clamped = b.source <= map.covered_from || a.source >= map.covered_to;
    if (is_clamped) continue;
    auto& fit = out.fit[index(piece.source_face)];
    fit.coverage += std::max(source_share, 0.0);
    if (source_share > 0.0) out.target_covered[index(piece.target_face)] += std::max(target_share, 0.0);
    for (const auto& point : {a, b})
      fit.gap = std::max(fit.gap, (point_at(source, point.source) - point_at(target, point.target)).norm());
  }

  const double size = source.arc.back() / static_cast<double>(source.n_faces());
  for (const auto i : map.missed_source) {
    const auto place = static_cast<double>(i);
    const bool is_clamped = place < map.covered_from || place > map.covered_to;
    if (is_clamped) {
      const double end = place < map.covered_from ? map.covered_from : map.covered_to;
      const double overhang = (source.x[i] - point_at(source, end)).norm();
      if (overhang <= negligible_share * size) continue;
      for (const auto k : {i, i + 1}) // the faces before and behind the node
        if (k >= 1 && k <= source.n_faces()) {
          auto& fit = out.fit[index(source.faces[k - 1])];
          fit.overhang = std::max(fit.overhang, overhang);
        }
    }
    out.missed_source.push_back(source.nodes[i]);
  }
  for (const auto j : map.missed_target) out.missed_target.push_back(target.nodes[j]);
}

/// A source loop and a target loop: both are walked once, from a source node that lands well.
void collect_loops(const Sides& sides, const Chain& source_chain, const Chain& target_chain, Collected& out)
{
  const bool against = runs_against(sides, source_chain.faces);
  const std::size_t n = source_chain.faces.size(), m = target_chain.faces.size();
  const Path whole = path_along(sides.target, target_chain, against, 0, m);
  const Path once = path_along(sides.source, source_chain, false, 0, n);
  for (std::size_t i = 0; i < n; ++i) {
    const double place = land_on_path(whole, once.x[i], once.normals[i]);
    if (place < 0.0) continue;
    const auto first = std::min(static_cast<std::size_t>(place), m - 1);
    const double xi = place - static_cast<double>(first);
    // The target's face in which both ends lie is walked twice: its end first, its beginning last.
    const Path target = path_along(sides.target, target_chain, against, first, m + 1);
    collect(path_along(sides.source, source_chain, false, i, n), target, {true, true, xi, xi + static_cast<double>(m)},
            out);
    return;
  }
  // No node of the source faces the target: nothing better than to cut both anywhere.
  collect(once, whole, {false, false, 0.0, static_cast<double>(m)}, out);
}

/// The target chain as a path for a part of the source that is no loop.
///
/// @param start, end  target nodes that are the part's ends, or -1
/// @param middle      of the source's part, for a loop that must be cut far away from it
std::pair<Path, PathEnds> target_path(const Sides& sides, const Chain& chain, bool against, std::int32_t start,
                                      std::int32_t end, const Point& middle)
{
  const std::size_t m = chain.faces.size();
  PathEnds ends{false, false, 0.0, static_cast<double>(m)};
  if (chain.is_loop) {
    std::size_t nearest = 0;
    double distance = std::numeric_limits<double>::infinity();
    const Path whole = path_along(sides.target, chain, against, 0, m);
    for (std::size_t j = 0; j < m; ++j)
      if (const double d = (whole.x[j] - middle).norm(); d < distance) nearest = j, distance = d;
    const double opposite = std::fmod(whole.arc[nearest] + 0.5 * whole.arc[m], whole.arc[m]);
    const auto cut = std::upper_bound(whole.arc.begin(), whole.arc.end(), opposite) - whole.arc.begin() - 1;
    return {path_along(sides.target, chain, against, std::min(static_cast<std::size_t>(cut), m - 1), m), ends};
  }
  const Path path = path_along(sides.target, chain, against, 0, m);
  ends.start_is_same = start >= 0 && path.nodes.front() == start;
  ends.end_is_same = end >= 0 && path.nodes.back() == end;
  return {path, ends};
}

/// Length of the source's faces whose centre is closest to each target chain [m].
std::vector<double> votes(const Sides& sides, const std::vector<std::int32_t>& faces)
{
  std::vector<double> length(sides.target_chains.size(), 0.0);
  for (const auto f : faces) {
    const auto closest = sides.target_tree.closest(face_centre(sides.source, f)).face;
    length[sides.chain_of_target_face[index(closest)]] += face_measure(sides.source, f);
  }
  return length;
}

/// Both ends of the source's chain are corners that the target has too: the target chain between the same two.
bool collect_between_matches(const Sides& sides, const Chain& chain, std::int32_t start, std::int32_t end,
                             Collected& out)
{
  const Chain* best = nullptr;
  double most = -1.0;
  const auto length = votes(sides, chain.faces); // several may join the same two: upper and lower side of a lens
  for (std::size_t c = 0; c < sides.target_chains.size(); ++c) {
    const auto& candidate = sides.target_chains[c];
    const auto first = candidate.nodes.front(), last = candidate.nodes.back();
    const bool fits = !candidate.is_loop && ((first == start && last == end) || (first == end && last == start));
    if (fits && length[c] > most) best = &candidate, most = length[c];
  }
  if (best == nullptr) return false;
  const bool against = start == end ? runs_against(sides, chain.faces) : best->nodes.front() == end;
  const Path target = path_along(sides.target, *best, against, 0, best->faces.size());
  collect(path_along(sides.source, chain, false, 0, chain.faces.size()), target,
          {true, true, 0.0, static_cast<double>(best->faces.size())}, out);
  return true;
}

/// For each face of a source chain the target chain that lies closest to its centre.
std::vector<std::size_t> nearest_chains(const Sides& sides, const Chain& chain, std::int32_t start, std::int32_t end)
{
  std::vector<std::size_t> nearest;
  std::vector<double> length(sides.target_chains.size(), 0.0);
  for (const auto f : chain.faces) {
    nearest.push_back(sides.chain_of_target_face[index(sides.target_tree.closest(face_centre(sides.source, f)).face)]);
    length[nearest.back()] += face_measure(sides.source, f);
  }
  // Beside a corner with a gap, the chain around the corner may be closer: the chain that most faces choose and that
  // ends in that corner takes these as well.
  const auto most = static_cast<std::size_t>(std::max_element(length.begin(), length.end()) - length.begin());
  const auto& nodes = sides.target_chains[most].nodes;
  const auto ends_in = [&](std::int32_t node) { return node >= 0 && (nodes.front() == node || nodes.back() == node); };
  if (ends_in(start))
    for (auto it = nearest.begin(); it != nearest.end() && *it != most; ++it) *it = most;
  if (ends_in(end))
    for (auto it = nearest.rbegin(); it != nearest.rend() && *it != most; ++it) *it = most;
  return nearest;
}

/// Where a source loop is cut when the target is none: where its faces change from one target chain to another, or
/// farthest from the only one.
std::size_t cut_of_loop(const Sides& sides, const Chain& chain, const std::vector<std::size_t>& nearest)
{
  const std::size_t n = chain.faces.size();
  for (std::size_t i = 0; i < n; ++i)
    if (nearest[i] != nearest[(i + n - 1) % n]) return i;
  std::size_t farthest = 0;
  double distance = -1.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double d = sides.target_tree.closest(node_position(sides.source, chain.nodes[i])).distance;
    if (d > distance) farthest = i, distance = d;
  }
  return farthest;
}

void collect_chain(const Sides& sides, const Chain& chain, Collected& out)
{
  const std::size_t n = chain.faces.size();
  const auto start = chain.is_loop ? -1 : sides.match[index(chain.nodes.front())];
  const auto end = chain.is_loop ? -1 : sides.match[index(chain.nodes.back())];
  if (start >= 0 && end >= 0 && collect_between_matches(sides, chain, start, end, out)) return;

  const auto nearest = nearest_chains(sides, chain, start, end);
  std::size_t first = 0;
  if (chain.is_loop) {
    const bool is_one = std::all_of(nearest.begin(), nearest.end(), [&](auto c) { return c == nearest[0]; });
    if (is_one && sides.target_chains[nearest[0]].is_loop)
      return collect_loops(sides, chain, sides.target_chains[nearest[0]], out);
    first = cut_of_loop(sides, chain, nearest);
  }
  for (std::size_t i = 0; i < n;) { // runs of faces that belong to one target chain
    const auto which = nearest[(first + i) % n];
    std::size_t count = 1;
    while (i + count < n && nearest[(first + i + count) % n] == which) ++count;
    const Path source = path_along(sides.source, chain, false, first + i, count);
    const auto& target_chain = sides.target_chains[which];
    const auto run_start = i == 0 ? start : -1, run_end = i + count == n ? end : -1;
    const auto [target, ends] = target_path(sides, target_chain, runs_against(sides, source.faces), run_start, run_end,
                                            point_at(source, 0.5 * static_cast<double>(count)));
    collect(source, target, ends, out);
    i += count;
  }
}

FaceList listed(std::vector<std::int32_t> numbers)
{
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  FaceList list;
  for (const auto number : numbers) list.add(number);
  return list;
}

OverlayReport report_on(const Sides& sides, const Collected& found, const PolylineNodes& source_nodes,
                        const PolylineNodes& target_nodes)
{
  OverlayReport report;
  report.fit = found.fit;
  report.is_opposite =
      sides.is_opposite ? *sides.is_opposite : normals_oppose(sides.source, sides.target, sides.target_tree);
  report.skipped_source_faces = listed(degenerate_faces(sides.source));
  report.skipped_target_faces = listed(degenerate_faces(sides.target));
  report.unmatched_source_nodes = listed(found.missed_source);

  std::vector<std::int32_t> unmatched;
  for (const auto node : source_nodes.features)
    if (sides.match[index(node)] < 0) unmatched.push_back(node);
  report.unmatched_source_features = listed(unmatched);
  unmatched.clear();
  for (const auto node : target_nodes.features)
    if (std::find(sides.match.begin(), sides.match.end(), node) == sides.match.end()) unmatched.push_back(node);
  report.unmatched_target_features = listed(unmatched);

  const auto skipped = degenerate_faces(sides.source);
  double covered = 0.0;
  for (std::int32_t f = 0; f < sides.source.n_faces(); ++f) {
    const auto& fit = found.fit[index(f)];
    const double share = fit.coverage;
    covered += share * face_measure(sides.source, f);
    report.largest_gap = std::max(report.largest_gap, fit.gap);
    report.largest_overhang = std::max(report.largest_overhang, fit.overhang);
    if (std::binary_search(skipped.begin(), skipped.end(), f)) continue;
    report.min_coverage = std::min(report.min_coverage, share);
    report.max_coverage = std::max(report.max_coverage, share);
    if (share <= negligible_share) report.uncovered_faces.add(f);
    else if (share < 1.0 - negligible_share) report.partly_covered_faces.add(f);
  }
  report.covered_fraction = covered / total_measure(sides.source);

  auto missed = found.missed_target; // and those that lie outside of what is covered
  double target_covered = 0.0;
  std::vector<bool> is_reached(static_cast<std::size_t>(sides.target.n_nodes()), false);
  for (std::int32_t f = 0; f < sides.target.n_faces(); ++f) {
    target_covered += std::min(found.target_covered[index(f)], 1.0) * face_measure(sides.target, f);
    if (found.target_covered[index(f)] > 0.0)
      for (const auto node : sides.target.face(f)) is_reached[index(node)] = true;
  }
  for (const auto node : sides.target.face_nodes)
    if (!is_reached[index(node)]) missed.push_back(node);
  report.unmatched_target_nodes = listed(missed);
  report.target_covered_fraction = target_covered / total_measure(sides.target);
  return report;
}

} // namespace

OverlayReport overlay_polylines(const SurfaceMesh& source, const SurfaceMesh& target,
                                const PolylineOverlayOptions& options, const SubelementSink& sink)
{
  const auto source_nodes = polyline_nodes(source, options.feature_angle);
  const auto target_nodes = polyline_nodes(target, options.feature_angle);
  Sides sides{source, target, FaceTree(target), {}, {}, {}, {}, options.is_opposite};
  sides.match = match_features(source, source_nodes, target, target_nodes, options.feature_tolerance);
  std::vector<bool> source_cut(index(static_cast<std::int32_t>(source.n_nodes())), false);
  std::vector<bool> target_cut(index(static_cast<std::int32_t>(target.n_nodes())), false);
  for (std::size_t i = 0; i < source_cut.size(); ++i)
    if (sides.match[i] >= 0) source_cut[i] = true, target_cut[index(sides.match[i])] = true;
  sides.source_chains = chains_of(source, source_nodes, source_cut);
  sides.target_chains = chains_of(target, target_nodes, target_cut);
  sides.chain_of_target_face.resize(static_cast<std::size_t>(target.n_faces()));
  for (std::size_t c = 0; c < sides.target_chains.size(); ++c)
    for (const auto f : sides.target_chains[c].faces) sides.chain_of_target_face[index(f)] = c;

  Collected found;
  found.fit.resize(static_cast<std::size_t>(source.n_faces()), {.coverage = 0.0});
  found.target_covered.resize(static_cast<std::size_t>(target.n_faces()), 0.0);
  for (const auto& chain : sides.source_chains) collect_chain(sides, chain, found);

  std::stable_sort(found.pieces.begin(), found.pieces.end(), [](const Subelement& a, const Subelement& b) {
    return std::tuple(a.source_face, a.target_face, a.source_xi[0][0]) <
           std::tuple(b.source_face, b.target_face, b.source_xi[0][0]);
  });
  const auto skipped = degenerate_faces(source);
  for (const auto& piece : found.pieces)
    if (!std::binary_search(skipped.begin(), skipped.end(), piece.source_face)) sink(piece);
  return report_on(sides, found, source_nodes, target_nodes);
}

} // namespace mullion::surface
