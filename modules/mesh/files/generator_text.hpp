// Generated meshes as texts, for case files: a name, the numbers of cells, and options in any order:
//
//   line:10,from=0:0,to=1:0                              10 lines, points have one to three coordinates
//   arc:20,radius=1,from=0,angle=90,centre=0:0           in the plane; angles in degrees
//   rectangle:32x24,triangles,size=2x1,origin=0:0:0,perturb=0.2,seed=3
//   cap:8x32,quads,radius=1,angle=60                     rings x cells around
//   wing:16x48,quads,span=4,root=1,tip=0.5,sweep=30,twist=-4,camber=0.02,perturb=0,seed=1
//   box:8x8,quads,size=1x1,origin=0:0,ratio=1:1,skew=0,perturb=0,seed=1   in the plane, with groups
//   box:8x8x4,tets,size=1x1x1,origin=0:0:0,ratio=1:1:1,perturb=0,seed=1
//   arch:24x1,length=0.34795,thickness=0.006,angle=15        a solid arch: groups wet, inner, start, end
//   duct_arch:34x60,length=0.34795,thickness=0.006,angle=15,height=1.25,growth=1.04,largest=0.045,left=-2.2,right=2.5
//                                                            over the arch, faces on it x rows; groups shell, floor,
//                                                            roof, inlet, outlet
//   box_arch:34x16,length=0.34795,thickness=0.006,angle=15,height=0.2,growth=1.04
//                                                            the same, shut: groups shell, floor, roof, left, right
//   bump:96x32,height=0.1                                    Ni's channel: groups bump, floor, roof, inlet, outlet
//   cook:8x8                                                 Cook's membrane: groups left, right, bottom, top
//
// Boxes have the groups x_min, x_max, y_min, … and all that have groups the group "volume" too. ratio is the size of
// the last cell by that of the first, along each axis; skew the amplitude of a smooth distortion in metres. Surfaces
// and what lies in the plane take quads, triangles, alternating (triangles cut along both diagonals in turn) or
// delaunay (cut along the better diagonal: with perturb an irregular mesh), and all but the cap take perturb and seed.
//
// All but the name and the numbers of cells may be left out; what stands here, "quads" and "hexes", lengths of 1 m, an
// arc of 90 and a cap of 60 degrees, and otherwise 0, are what is taken then.
#pragma once

#include "mesh_file.hpp"

#include <string>

namespace mullion::mesh_files {

/// Does the text begin with the name of a generator and a colon?
bool is_generator_text(const std::string& text);

/// @throws FileError that shows the text, what is wrong in it, and what would be right
MeshFile generated(const std::string& text);

} // namespace mullion::mesh_files
