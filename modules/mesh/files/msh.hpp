// Gmsh's mesh files: versions 2.x and 4.1 are read, as text or binary, and 4.1 is written as text. Groups are the
// physical groups, by their names (an unnamed one is called by its number).
//
// Linear elements only; another one is an error that names it. Partitioned meshes are not read.
#pragma once

#include "mesh_file.hpp"

#include <string>
#include <string_view>

namespace mullion::mesh_files {

/// @param file       for messages
/// @param bytes      of the whole file
/// @param dimension  of space; 0: the smallest in which the nodes lie
/// @throws FileError "FILE:LINE: …", or "FILE, byte N: …" for binary files
MeshFile parse_msh(const std::string& file, std::string_view bytes, int dimension = 0);

/// The mesh as text of version 4.1. Reading it gives the same nodes, to the bit, elements and groups; nodes are
/// numbered from 1 on, and elements of one shape that are in the same groups stay in their order.
/// @throws FileError where there is no element, or a group's name has a quote or a line break
std::string msh_text(const MeshFile& mesh);

} // namespace mullion::mesh_files
