// The common refinement of two polylines: all pieces that lie in one face of either side. Corners and ends that both
// sides have are brought together first, so that nothing of one side of a corner reaches the other.
#pragma once

#include "subelement.hpp"
#include "surface_mesh.hpp"

#include <optional>

namespace mullion::surface {

struct PolylineOverlayOptions {
  double feature_angle = 0.6981317007977318; ///< [rad], 40 degrees: a node that turns by more is a corner
  double feature_tolerance = 0.3;            ///< of a face: corners and ends closer than this are the same
  std::optional<bool> is_opposite = {};      ///< normals point against each other; found from the geometry if not given
};

/// Overlay of two polylines in 2D: common refinement after Jiao & Heath 2004.
///
/// Within a piece the local coordinates of both sides vary linearly. Every source face is covered once, from end to
/// end: where the source reaches beyond the end of the target, its piece belongs to the target's end node (target
/// coordinates equal at both ends), which keeps the force and spoils the traction there; the report counts it as not
/// covered. Parts of the target that no source reaches, and source
/// faces without length, get no piece. Two chains of n and m faces give n + m + 1 pieces
/// at most, n + m - 1 if their ends are the same.
///
/// @param sink  gets the pieces by source face, by target face within, and in the source's direction within that
/// @pre   complaint_about() == "" for both, dimension 2
[[nodiscard]] OverlayReport overlay_polylines(const SurfaceMesh& source, const SurfaceMesh& target,
                                              const PolylineOverlayOptions& options, const SubelementSink& sink);

} // namespace mullion::surface
