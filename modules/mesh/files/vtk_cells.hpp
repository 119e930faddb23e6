// The cells of VTK as elements: what the legacy and the XML format have in common.
#pragma once

#include "raw_mesh.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace mullion::mesh_files {

/// Throws a FileError of what was found and what would be right, with the place in the file.
using Fail = std::function<void(const std::string& found, const std::string& right)>;

/// Prefix of the name of a cell array that marks the cells of a group with 1: "group:wall".
inline constexpr const char* group_prefix = "group:";

/// Where each node of a prism6 stands in a VTK_WEDGE, whose first triangle has its normal out of the cell; and back.
inline constexpr std::array<std::size_t, 6> vtk_wedge_order = {0, 2, 1, 3, 5, 4};

/// Add points; the first number is that of VTK, 0.
/// @param coordinates 3 a point
void add_vtk_points(RawMesh& raw, std::span<const double> coordinates);

/// Add one cell; pixels and voxels become quadrilaterals and hexahedra.
Element add_vtk_cell(RawMesh& raw, std::int64_t type, std::span<const std::int64_t> nodes, const Fail& fail);

/// The kinds of cells in a legacy POLYDATA file.
enum class PolyCells { vertices, lines, polygons, strips };

/// Add one entry of POLYDATA: its points, its segments, its triangle or quadrilateral, or the triangles of its strip.
void add_vtk_poly_cell(RawMesh& raw, PolyCells kind, std::span<const std::int64_t> nodes, const Fail& fail);

} // namespace mullion::mesh_files
