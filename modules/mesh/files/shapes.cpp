#include "shapes.hpp"

#include <utility>

namespace mullion::mesh_files {
namespace {

using Name = std::pair<std::int64_t, const char*>;

template <std::size_t n> std::string find(const std::array<Name, n>& names, std::int64_t type)
{
  for (const auto& [number, name] : names)
    if (number == type) return name;
  return "unknown";
}

} // namespace

std::string foreign_gmsh_type(std::int64_t type)
{
  static constexpr std::array<Name, 23> names = {
      {{8, "line3, second order"},          {9, "triangle6, second order"},     {10, "quadrangle9, second order"},
       {11, "tetrahedron10, second order"}, {12, "hexahedron27, second order"}, {13, "prism18, second order"},
       {14, "pyramid14, second order"},     {16, "quadrangle8, second order"},  {17, "hexahedron20, second order"},
       {18, "prism15, second order"},       {19, "pyramid13, second order"},    {20, "triangle9, third order"},
       {21, "triangle10, third order"},     {22, "triangle12, fourth order"},   {23, "triangle15, fourth order"},
       {24, "triangle15, fifth order"},     {25, "triangle21, fifth order"},    {26, "line4, third order"},
       {27, "line5, fourth order"},         {28, "line6, fifth order"},         {29, "tetrahedron20, third order"},
       {30, "tetrahedron35, fourth order"}, {31, "tetrahedron56, fifth order"}}};
  return find(names, type);
}

std::string foreign_vtk_type(std::int64_t type)
{
  static constexpr std::array<Name, 20> names = {{{0, "VTK_EMPTY_CELL"},
                                                  {2, "VTK_POLY_VERTEX"},
                                                  {4, "VTK_POLY_LINE"},
                                                  {6, "VTK_TRIANGLE_STRIP"},
                                                  {7, "VTK_POLYGON"},
                                                  {15, "VTK_PENTAGONAL_PRISM"},
                                                  {16, "VTK_HEXAGONAL_PRISM"},
                                                  {21, "VTK_QUADRATIC_EDGE"},
                                                  {22, "VTK_QUADRATIC_TRIANGLE"},
                                                  {23, "VTK_QUADRATIC_QUAD"},
                                                  {24, "VTK_QUADRATIC_TETRA"},
                                                  {25, "VTK_QUADRATIC_HEXAHEDRON"},
                                                  {26, "VTK_QUADRATIC_WEDGE"},
                                                  {27, "VTK_QUADRATIC_PYRAMID"},
                                                  {28, "VTK_BIQUADRATIC_QUAD"},
                                                  {29, "VTK_TRIQUADRATIC_HEXAHEDRON"},
                                                  {34, "VTK_BIQUADRATIC_TRIANGLE"},
                                                  {42, "VTK_POLYHEDRON"},
                                                  {69, "VTK_LAGRANGE_TRIANGLE"},
                                                  {70, "VTK_LAGRANGE_QUADRILATERAL"}}};
  return find(names, type);
}

} // namespace mullion::mesh_files
