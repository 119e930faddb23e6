// VTK's files. Legacy (.vtk), text or binary, POLYDATA and UNSTRUCTURED_GRID, versions up to 5.1, is read; its data
// arrays are passed over, so it has no groups. XML (.vtu), with data as text, base64 or raw, inline or appended,
// compressed by zlib or not, is read and, as text, written; an integer cell array "group:NAME" marks a group's cells.
//
// Linear cells only; another one is an error that names it.
#pragma once

#include "mesh_file.hpp"

#include <string>
#include <string_view>

namespace mullion::mesh_files {

/// @param file       for messages
/// @param bytes      of the whole file
/// @param dimension  of space; 0: the smallest in which the nodes lie
/// @throws FileError "FILE:LINE: …", or "FILE, byte N: …" for binary files
MeshFile parse_vtk(const std::string& file, std::string_view bytes, int dimension = 0);
MeshFile parse_vtu(const std::string& file, std::string_view bytes, int dimension = 0);

/// The mesh as a VTU file with text data. Reading it gives the same mesh, coordinates to the bit; nodes are numbered
/// from 0 on.
std::string vtu_text(const MeshFile& mesh);

} // namespace mullion::mesh_files
