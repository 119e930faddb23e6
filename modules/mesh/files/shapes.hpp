// The element shapes that meshes consist of: their numbers of nodes, dimensions and names. The numbers and the order
// of an element's nodes are those of the module SDK and of Gmsh. VTK's differs in the wedge only.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace mullion::mesh_files {

enum class Shape : std::uint32_t {
  point1 = 0,
  line2 = 1,
  triangle3 = 2,
  quadrilateral4 = 3,
  tetrahedron4 = 4,
  pyramid5 = 5,
  prism6 = 6,
  hexahedron8 = 7
};

inline constexpr std::size_t n_shapes = 8;
inline constexpr std::size_t most_nodes = 8; ///< of any shape

struct ShapeFacts {
  const char* name;
  int n_nodes, dimension;
  int gmsh_type, vtk_type;
};

inline constexpr std::array<ShapeFacts, n_shapes> shape_facts = {{{"point1", 1, 0, 15, 1},
                                                                  {"line2", 2, 1, 1, 3},
                                                                  {"triangle3", 3, 2, 2, 5},
                                                                  {"quadrilateral4", 4, 2, 3, 9},
                                                                  {"tetrahedron4", 4, 3, 4, 10},
                                                                  {"pyramid5", 5, 3, 7, 14},
                                                                  {"prism6", 6, 3, 6, 13},
                                                                  {"hexahedron8", 8, 3, 5, 12}}};

constexpr const ShapeFacts& facts(Shape shape) { return shape_facts[static_cast<std::size_t>(shape)]; }

/// Gmsh's name of an element type that is no shape of ours, say "triangle6, second order"; "unknown" for a number
/// that Gmsh does not have either.
std::string foreign_gmsh_type(std::int64_t type);
/// The same for VTK, say "VTK_QUADRATIC_TRIANGLE".
std::string foreign_vtk_type(std::int64_t type);

} // namespace mullion::mesh_files
