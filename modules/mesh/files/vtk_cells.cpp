#include "vtk_cells.hpp"

#include "file_error.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace mullion::mesh_files {
namespace {

Element add(RawMesh& raw, Shape shape, std::span<const std::int64_t> nodes, const Fail& fail)
{
  std::array<Index, most_nodes> indices{};
  const auto n = static_cast<std::size_t>(facts(shape).n_nodes);
  if (nodes.size() != n) fail(join("a ", facts(shape).name, " of ", nodes.size(), " nodes"), join("it has ", n));
  for (std::size_t k = 0; k < n; ++k) {
    if (nodes[k] < 0 || static_cast<std::size_t>(nodes[k]) >= n_nodes(raw))
      fail(join("a cell with the point ", nodes[k]), join("points are 0 to ", n_nodes(raw), " - 1"));
    indices[k] = static_cast<Index>(nodes[k]);
  }
  return add_element(raw, shape, {indices.data(), n});
}

} // namespace

void add_vtk_points(RawMesh& raw, std::span<const double> coordinates)
{
  raw.coordinates.insert(raw.coordinates.end(), coordinates.begin(), coordinates.end());
  if (raw.coordinates.size() / 3 > static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw FileError("the mesh has more points than can be numbered");
  while (raw.numbers.size() < raw.coordinates.size() / 3)
    raw.numbers.push_back(static_cast<std::int64_t>(raw.numbers.size()));
}

Element add_vtk_cell(RawMesh& raw, std::int64_t type, std::span<const std::int64_t> nodes, const Fail& fail)
{
  // Pixels and voxels count their points row by row.
  if (type == 8 && nodes.size() == 4) {
    const std::array<std::int64_t, 4> around = {nodes[0], nodes[1], nodes[3], nodes[2]};
    return add(raw, Shape::quadrilateral4, around, fail);
  }
  if (type == 11 && nodes.size() == 8) {
    const std::array<std::int64_t, 8> around = {nodes[0], nodes[1], nodes[3], nodes[2],
                                                nodes[4], nodes[5], nodes[7], nodes[6]};
    return add(raw, Shape::hexahedron8, around, fail);
  }
  if (type == shape_facts[static_cast<std::size_t>(Shape::prism6)].vtk_type && nodes.size() == 6) {
    std::array<std::int64_t, 6> turned{};
    for (std::size_t k = 0; k < 6; ++k) turned[k] = nodes[vtk_wedge_order[k]];
    return add(raw, Shape::prism6, turned, fail);
  }
  for (std::size_t s = 0; s < n_shapes; ++s)
    if (shape_facts[s].vtk_type == type) return add(raw, static_cast<Shape>(s), nodes, fail);
  fail(join("a cell of type ", type, " (", foreign_vtk_type(type), ") with ", nodes.size(), " points"),
       "cells are linear: vertex, line, triangle, quad, tetra, pyramid, wedge, hexahedron, pixel or voxel");
  return {};
}

void add_vtk_poly_cell(RawMesh& raw, PolyCells kind, std::span<const std::int64_t> nodes, const Fail& fail)
{
  switch (kind) {
  case PolyCells::vertices:
    for (std::size_t k = 0; k < nodes.size(); ++k) add(raw, Shape::point1, nodes.subspan(k, 1), fail);
    break;
  case PolyCells::lines:
    if (nodes.size() < 2) fail(join("a line of ", nodes.size(), " points"), "at least two");
    for (std::size_t k = 0; k + 1 < nodes.size(); ++k) add(raw, Shape::line2, nodes.subspan(k, 2), fail);
    break;
  case PolyCells::polygons:
    if (nodes.size() != 3 && nodes.size() != 4)
      fail(join("a polygon of ", nodes.size(), " points"), "polygons are triangles or quadrilaterals");
    add(raw, nodes.size() == 3 ? Shape::triangle3 : Shape::quadrilateral4, nodes, fail);
    break;
  case PolyCells::strips:
    if (nodes.size() < 3) fail(join("a triangle strip of ", nodes.size(), " points"), "at least three");
    for (std::size_t k = 0; k + 2 < nodes.size(); ++k) { // every second triangle runs the other way
      std::array<std::int64_t, 3> triangle = {nodes[k], nodes[k + 1], nodes[k + 2]};
      if (k % 2 == 1) std::swap(triangle[0], triangle[1]);
      add(raw, Shape::triangle3, triangle, fail);
    }
    break;
  }
}

} // namespace mullion::mesh_files
