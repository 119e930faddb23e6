// The common refinement of two surfaces in 3D: all pieces that lie in one face of either side, with local coordinates
// in both. What the integrals of the load transfer are taken over. Lines in 2D have an algorithm of their own.
#pragma once

#include "subelement.hpp"
#include "surface_mesh.hpp"

#include <optional>

namespace mullion::surface {

struct SurfaceOverlayOptions {
  double gap_tolerance = 0.0; ///< largest distance of paired points [m]; 0: twice the larger mean face size
  std::optional<bool> opposite =
      std::nullopt; ///< the sides' normals point against each other; not given: found, see below
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
/// surface; where they stand off by d it is as good as the normals, O(d h) (O(d h^2) on spheres).
///
/// - A pair of faces counts if the normals are within 78 degrees of each other (the other sheet of a thin body does
///   not) and the distance along the normals is within the tolerance. The layers within a tenth of the faces' sizes
///   are asked first; only a source face that they do not cover looks further.
/// - A source quadrilateral is taken in its mean plane, by halves if it is warped by more than 10 degrees or has a
///   corner that points inwards. Local coordinates are bilinear also then, but with an inward corner linear by halves.
/// - Pieces smaller than 1e-14 of the smaller face's squared length are dropped. Degenerate faces are skipped.
/// - A source face that is covered by less than 1e-6 counts as uncovered: its pieces are then the triangles from its
///   centre to its edges, each attached to the one point of the target that is closest to the triangle's centre.
///   A face covered in part keeps its pieces; whoever assembles scales them.
/// - The orientation, unless given, is that of up to 500 source faces against the target face closest to each. For
///   bodies thinner than the gap between the two meshes it has to be given.
///
/// Within a piece positions are linear between the vertices; local coordinates of a quadrilateral are not: see
/// interpolate_local().
///
/// @param source, target  in 3D; @pre complaint_about() has none
/// @param sink            gets every piece; ascending source faces, ascending target faces within
/// @return                coverages: areas in the source face's plane over the face's own. Without target faces all
///                        source faces are uncovered and nothing is handed out
OverlayReport overlay_surfaces(const SurfaceMesh& source, const SurfaceMesh& target,
                               const SurfaceOverlayOptions& options, const SubelementSink& sink);

} // namespace mullion::surface
