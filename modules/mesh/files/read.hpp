// A mesh from what a case file says: the name of a file, or the text of a generator.
#pragma once

#include "mesh_file.hpp"

#include <string>

namespace mullion::mesh_files {

/// Read a file; its ending says its format: .msh, .vtk or .vtu.
/// @param dimension  of space; 0: the smallest in which the nodes lie
/// @throws FileError, also if it cannot be opened
MeshFile read_mesh(const std::string& file, int dimension = 0);

/// Write a file; its ending says its format: .msh or .vtu.
/// @throws FileError
void write_mesh(const MeshFile& mesh, const std::string& file);

/// The mesh of a file, or of a generator's text: see generator_text.hpp.
MeshFile read_or_generate(const std::string& text, int dimension = 0);

/// The surface of a mesh that is an interface: one group, or the whole mesh for "". The space has one dimension more
/// than the elements, at least: a flat mesh of triangles is a surface in space, one of lines a curve in the plane.
/// @throws FileError if the elements are of several dimensions, or volumes
MeshFile interface_of(const MeshFile& mesh, const std::string& group);

} // namespace mullion::mesh_files
