// A module's mesh for those who want to look at it, as it was read or generated: windows hold nodes and elements, the
// names of the boundaries are known here alone. A module offers these as its functions `write_mesh` and
// `list_boundaries`; functions take numbers, hence the descriptor, which the caller opened in the same process.
#pragma once

#include <string>

namespace mullion::mesh_files {

/// Write the mesh as a file of Gmsh, version 4.1, its groups as physical groups.
/// @param text        of a generator, or the name of a file, as read_or_generate() takes it
/// @param dimension   of space; 0: the smallest in which the nodes lie
/// @param descriptor  an open file
/// @return            bytes written
/// @throws FileError  also where nothing can be written there
double write_mesh_to(const std::string& text, int dimension, double descriptor);

/// Write a line for each group of the boundary, one dimension below the largest element: "80 x_min", number of faces
/// and name.
/// @return  number of lines
/// @throws FileError
double list_boundaries_to(const std::string& text, int dimension, double descriptor);

} // namespace mullion::mesh_files
