// From a mesh file's groups to the patches of the boundary: which face of which cell belongs to which condition.
#pragma once

#include "mesh.hpp"

#include <string>
#include <vector>

namespace mullion::euler {

/// Names in a text, with commas between them: "wall, bump". Empty for a text without any.
/// @throws MeshError for a missing name between two commas
std::vector<std::string> names_in(const std::string& text);

/// "x_min:x_max, y_min:y_max": the pairs, as names.
/// @throws MeshError unless each is two names with a colon
std::vector<std::pair<std::string, std::string>> pairs_in(const std::string& text);

/// Cells of a mesh file, and the patch of each face on the boundary: patch k holds the faces of the group patches[k].
///
/// @throws MeshError: no such group; a group whose elements are not on the boundary; a face in two patches; faces in
///         none, with the names of the groups that they lie in; a cell of no area or whose nodes go the wrong way round
template <int D> MeshSource<D> source_of(const mesh_files::MeshFile& file, const std::vector<std::string>& patches);

} // namespace mullion::euler
