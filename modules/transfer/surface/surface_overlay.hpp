// The common refinement of two surfaces in 3D: all pieces that lie in one face of either side, with local coordinates
// in both. What the integrals of the load transfer are taken over. Lines in 2D have an algorithm of their own.
#pragma once

#include "subelement.hpp"
#include "surface_mesh.hpp"

#include <optional>

namespace mullion::surface {

struct SurfaceOverlayOptions {
  /// Largest distance of paired points [m]; 0: twice the larger of the two meshes' mean face sizes.
  double gap_tolerance = 0.0;
  /// The sides' normals point against each other. Not given: as most of up to 500 source faces do against the target
  /// face that is closest to each; for bodies thinner than the gap between the two meshes it has to be given.
  std::optional<bool> opposite = std::nullopt;
};

/// Overlay two surfaces and hand out the pieces, source face by source face.
///
/// Each source face is a polygon in its plane. Of every target face near it the image in that plane is taken: its
/// corners x_j go along the target's nodal normals n_j,
///
///     x_j' = x_j + tau_j n_j,   tau_j = m . (x_0 - x_j) / m . n_j     (m, x_0: normal and a point of the plane)
///
/// and the image of a triangle is the triangle of the images of its corners. Images of neighbours share their edges,
/// so they tile the plane: what is cut out of them by the source face (Sutherland & Hodgman 1974) covers it exactly
/// once, whatever the gap and however the target is curved, and needs no scaling. Jiao & Heath 2004 project along
/// interpolated normals of the target too; they follow the source's edges from face to face, which tiles the target
/// as well; here neighbouring source faces leave out, or cover twice, a share O(h^2) of the target.
///
/// The pairing is exact for planes, and off by O(h^3) along the surface where both meshes interpolate one smooth
/// surface; where they stand off by d it is as good as the normals, O(d h) (O(d h^2) on spheres, but for the rim).
///
/// - A pair of faces counts if their normals are within 78 degrees of each other, so that the other sheet of a thin
///   body does not, and the distance along the nodal normals is within the tolerance. The search begins within a tenth
///   of the faces' sizes and goes on, four times as far each time, only for a source face that is not covered; what
///   covers it best counts. So a second layer behind the first one does not.
/// - A source quadrilateral is taken in its mean plane, or by halves: see plane_face(). The image of a target
///   quadrilateral is cut in two if a corner of it points inwards. Local coordinates are those of the bilinear map of
///   the images' corners, in halves of a face with an inward corner linear.
/// - Pieces smaller than 1e-14 of the smaller face's squared length are dropped. Degenerate faces are skipped.
/// - A source face that is covered by less than 1e-6 counts as uncovered and has no pieces. A face covered in part has
///   some; whoever assembles scales them, or sends the rest elsewhere.
///
/// Within a piece places are linear between the vertices; local coordinates are so in triangles only. Whoever
/// integrates over the piece finds those of a quadrilateral from the place (invert_quadrilateral()), or linear fields
/// are not reproduced.
///
/// @param source, target  in 3D; @pre complaint_about() has none
/// @param sink            gets every piece; ascending source faces, ascending target faces within
/// @return                coverage is the area of a face's pieces over its own, both in its plane. Neither features nor
///                        source nodes are matched: their lists stay empty
OverlayReport overlay_surfaces(const SurfaceMesh& source, const SurfaceMesh& target,
                               const SurfaceOverlayOptions& options, const SubelementSink& sink);

} // namespace mullion::surface
