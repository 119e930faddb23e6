// What an overlay of two surface meshes delivers: the pieces that lie in one face of either side, and a report of how
// well the two sides cover each other. Overlays (2D, 3D) write these, the assembly of the operators reads them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace mullion::surface {

/// A piece of the overlay that lies in one source face and one target face: a segment (2D, 2 vertices) or a convex
/// polygon (3D, up to 8), with the local coordinates of its vertices in both parents.
///
/// Line: xi in [0, 1]. Triangle: barycentric (xi, eta) of nodes 1 and 2. Quadrilateral: bilinear (xi, eta) in [0, 1]^2.
struct Subelement {
  std::int32_t source_face = 0, target_face = 0;
  int n_vertices = 0;
  double source_xi[8][2] = {};
  double target_xi[8][2] = {};
};

/// Receives subelements grouped by source face, in ascending source face order, target faces ascending within.
using SubelementSink = std::function<void(const Subelement&)>;

/// How many of something there are, and the first few by number.
struct FaceList {
  static constexpr std::size_t max_listed = 20;
  std::int64_t count = 0;
  std::vector<std::int32_t> first; ///< at most max_listed, in ascending order

  void add(std::int32_t number)
  {
    ++count;
    if (first.size() < max_listed) first.push_back(number);
  }
};

/// How a source face meets the target.
struct FaceFit {
  double coverage = 1.0; ///< overlaid measure / own measure, before any scaling; 0: no counterpart
  double gap = 0.0;      ///< largest between its paired points [m]
  double overhang = 0.0; ///< by which it reaches beyond the target's end [m]
};

/// How well two surfaces cover each other, before any scaling.
struct OverlayReport {
  std::vector<FaceFit> fit;             ///< of each source face, for messages that name places; may be left out
  double min_coverage = 1.0;            ///< over the source faces: overlaid measure / own measure
  double max_coverage = 1.0;            ///< the same, largest
  double largest_gap = 0.0;             ///< between paired points [m]
  double largest_overhang = 0.0;        ///< by which a source node lies beyond the target's end [m]
  double covered_fraction = 1.0;        ///< of the source's measure that has a counterpart
  double target_covered_fraction = 1.0; ///< of the target's measure that has a counterpart
  bool is_opposite = false;             ///< the two sides' normals point against each other
  FaceList uncovered_faces;             ///< source faces without any counterpart
  FaceList partly_covered_faces;        ///< source faces with some
  FaceList unmatched_source_features;   ///< source nodes: corners and ends without a partner
  FaceList unmatched_target_features;   ///< target nodes: corners and ends without a partner
  FaceList unmatched_source_nodes;      ///< source nodes whose place on the target had to be interpolated or clamped
  FaceList unmatched_target_nodes;      ///< target nodes that no source point reaches
  FaceList skipped_source_faces;        ///< degenerate
  FaceList skipped_target_faces;        ///< degenerate
};

} // namespace mullion::surface
