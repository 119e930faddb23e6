// Generated meshes as texts, for case files: a name, the numbers of cells, and options in any order:
//
//   line:10,from=0:0,to=1:0                              10 lines, points have one to three coordinates
//   arc:20,radius=1,from=0,angle=90,centre=0:0           in the plane; angles in degrees
//   rectangle:32x24,triangles,size=2x1,origin=0:0:0,perturb=0.2,seed=3
//   cap:8x32,quads,radius=1,angle=60                     rings x cells around
//   wing:16x48,quads,span=4,root=1,tip=0.5,sweep=30,twist=-4,camber=0.02,perturb=0,seed=1
//   box:8x8,quads,size=1x1,origin=0:0,perturb=0,seed=1   in the plane, with groups
//   box:8x8x4,tets,size=1x1x1,origin=0:0:0,perturb=0,seed=1
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
