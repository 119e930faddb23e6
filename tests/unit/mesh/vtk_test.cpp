// VTK's files, legacy and XML: those that Gmsh and meshio wrote, our own, ones put together by hand, and broken ones.
#include "files/file_error.hpp"
#include "files/generators.hpp"
#include "files/msh.hpp"
#include "files/vtk.hpp"
#include "support/mesh_samples.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

using namespace mullion::mesh_files;
using namespace mullion::testing;

namespace {

template <class Parse> std::string complaint_of(Parse parse, const std::string& text)
{
  try {
    parse("m", text, 0);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

std::string vtk_complaint(const std::string& text) { return complaint_of(parse_vtk, text); }
std::string vtu_complaint(const std::string& text) { return complaint_of(parse_vtu, text); }

bool contains(const std::string& text, const std::string& piece) { return text.find(piece) != std::string::npos; }

std::string replaced(std::string text, const std::string& from, const std::string& to)
{
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

const std::string legacy = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                           "POINTS 4 double\n0 0 0  1 0 0  1 1 0  0 1 0\nCELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n5\n";
const std::string poly = "# vtk DataFile Version 3.0\ntitle\nASCII\nDATASET POLYDATA\n"
                         "POINTS 4 float\n0 0 0  1 0 0  0 1 0  1 1 0\n";

/// The bytes of numbers in the order of this machine, or the other one.
template <class T> std::string bytes_of(const std::vector<T>& values, bool is_swapped = false)
{
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  for (std::size_t at = 0; is_swapped && at < bytes.size(); at += sizeof(T))
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                 bytes.begin() + static_cast<std::ptrdiff_t>(at + sizeof(T)));
  return bytes;
}

/// Binary data of a VTU file: their size, and they.
template <class T> std::string sized(const std::vector<T>& values, bool is_swapped = false)
{
  const std::vector<std::uint32_t> size = {static_cast<std::uint32_t>(values.size() * sizeof(T))};
  return bytes_of(size, is_swapped) + bytes_of(values, is_swapped);
}

std::string base64(const std::string& bytes)
{
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t bits = 0;
    const auto n = std::min<std::size_t>(3, bytes.size() - at);
    for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (k < n ? static_cast<unsigned char>(bytes[at + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= n ? digits[bits >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

/// A triangle of which all arrays are appended.
std::string appended_vtu(const std::string& encoding, bool is_big_endian = false)
{
  const bool is_raw = encoding == "raw";
  const bool is_swapped = is_big_endian == (std::endian::native == std::endian::little);
  const std::vector<std::string> data = {sized(std::vector<double>{0, 0, 0, 1, 0, 0, 0, 1, 0.5}, is_swapped),
                                         sized(std::vector<std::int32_t>{2, 0, 1}, is_swapped),
                                         sized(std::vector<std::int64_t>{3}, is_swapped),
                                         sized(std::vector<std::uint8_t>{5}, is_swapped)};
  std::vector<std::string> offsets;
  std::string all;
  for (const auto& array : data) {
    offsets.push_back(std::to_string(all.size()));
    all += is_raw ? array : base64(array);
  }
  return std::string("<VTKFile type=\"UnstructuredGrid\" byte_order=\"") +
         (is_big_endian ? "BigEndian" : "LittleEndian") +
         "\"><UnstructuredGrid>"
         "<Piece NumberOfPoints=\"3\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
         "NumberOfComponents=\"3\" format=\"appended\" offset=\"" +
         offsets[0] +
         "\"/></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"appended\" offset=\"" +
         offsets[1] + "\"/><DataArray type=\"Int64\" Name=\"offsets\" format=\"appended\" offset=\"" + offsets[2] +
         "\"/><DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"" + offsets[3] +
         "\"/></Cells></Piece></UnstructuredGrid><AppendedData encoding=\"" + encoding + "\">\n_" + all +
         "\n</AppendedData></VTKFile>\n";
}

} // namespace

TEST_CASE("legacy VTK files of Gmsh and meshio hold the meshes of their MSH files, the wedge's nodes turned")
{
  const auto cube = parse_msh("cube", mesh_sample("cube_msh41_a.msh"));
  const auto shapes = parse_msh("shapes", mesh_sample("shapes_msh2_a.msh"));

  const auto cube_again = parse_vtk("cube", mesh_sample("cube_b.vtk"));

  CHECK(cube_again.nodes == cube.nodes);
  CHECK(elements_of(cube_again, Shape::hexahedron8) == elements_of(cube, Shape::hexahedron8));
  for (const char* name : {"shapes_a.vtk", "shapes_b.vtk"}) {
    const auto again = parse_vtk(name, mesh_sample(name));
    CHECK(again.nodes == shapes.nodes);
    for (const auto& block : shapes.blocks) CHECK(elements_of(again, block.shape) == block.connectivity);
  }
}

TEST_CASE("VTU files of meshio are the same as text, base64 and compressed, with a group from a marked array")
{
  const auto shapes = parse_msh("shapes", mesh_sample("shapes_msh2_a.msh"));
  for (const std::string name : {"shapes_a.vtu", "shapes_b.vtu", "shapes_z.vtu"}) {
    CAPTURE(name);
    const auto mesh = parse_vtu(name, mesh_sample(name));

    CHECK(mesh.nodes == shapes.nodes);
    for (const auto& block : shapes.blocks) CHECK(elements_of(mesh, block.shape) == block.connectivity);
    const auto wall = only(mesh, find_group(mesh, "wall"));
    CHECK(elements_of(wall, Shape::triangle3).cols() == 1);
    CHECK(elements_of(wall, Shape::quadrilateral4).cols() == 1);
  }
}

TEST_CASE("appended data of a VTU file are read raw and as base64, whichever byte comes first")
{
  for (const std::string encoding : {"raw", "base64"})
    for (const bool is_big_endian : {false, true}) {
      CAPTURE(encoding);
      CAPTURE(is_big_endian);
      const auto mesh = parse_vtu("appended", appended_vtu(encoding, is_big_endian));

      CHECK(mesh.nodes.col(2) == Eigen::Vector3d(0.0, 1.0, 0.5));
      CHECK(elements_of(mesh, Shape::triangle3) == Connectivity(Eigen::Vector3i(2, 0, 1)));
    }
}

TEST_CASE("the pieces of a VTU file are one mesh")
{
  auto text = vtu_text(box_2d({1, 1, Cells::quads, {}}, {1, 1}));
  const auto begin = text.find("<Piece"), end = text.find("</UnstructuredGrid>");
  text.insert(end, text.substr(begin, end - begin));

  const auto mesh = parse_vtu("m", text);

  CHECK(mesh.nodes.cols() == 8);
  CHECK(elements_of(mesh, Shape::quadrilateral4).col(1) == Eigen::Vector4i(4, 5, 7, 6));
  CHECK(find_group(mesh, "x_min").elements.size() == 2);
}

TEST_CASE("a header of a base64 array may be a text of its own")
{
  const std::vector<double> x = {0, 0, 0, 1, 0, 0};
  const auto file = [&](const std::string& points) {
    return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"2\" NumberOfCells=\"1\">"
           "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"binary\">\n" +
           points +
           "\n</DataArray></Points><Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1"
           "</DataArray><DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">2</DataArray>"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">3</DataArray></Cells></Piece>"
           "</UnstructuredGrid></VTKFile>";
  };

  const auto together = parse_vtu("m", file(base64(sized(x)))),
             apart = parse_vtu("m", file(base64(sized(x).substr(0, 4)) + base64(bytes_of(x))));

  CHECK(together.nodes == Eigen::RowVector2d(0.0, 1.0));
  CHECK(apart.nodes == together.nodes);
  CHECK(contains(vtu_complaint(file("@@@@")), "no base64"));
  CHECK(contains(vtu_complaint(file(base64(sized(x)).substr(0, 20))), "cut off or damaged"));
}

TEST_CASE("what is written as VTU is read again to the bit")
{
  for (const auto& mesh :
       {parse_msh("cube", mesh_sample("cube_msh41_a.msh")), parse_msh("shapes", mesh_sample("shapes_msh2_a.msh")),
        box_2d({3, 2, Cells::triangles, {0.2, 5}}, {1.0, 0.3}), spherical_cap(3, 5, Cells::quads, 1.0, 1.0)}) {
    CHECK(is_same(parse_vtu("again", vtu_text(mesh), mesh.dimension), mesh));
  }
}

TEST_CASE("names of groups with signs of XML survive")
{
  auto mesh = box_2d({1, 1, Cells::quads, {}}, {1, 1});
  mesh.groups[0].name = "a<b & \"c\"";

  CHECK(is_same(parse_vtu("again", vtu_text(mesh)), mesh));
}

TEST_CASE("the cell lists of version 5.1 are read, and data arrays passed over")
{
  const auto mesh = parse_vtk("m", "# vtk DataFile Version 5.1\nt\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                                   "FIELD FieldData 1\nTIME 1 1 double\n0.5\nPOINTS 4 double\n0 0 0 1 0 0 1 1 0 0 1 0\n"
                                   "METADATA\nINFORMATION 0\n\nCELLS 3 7\nOFFSETS vtktypeint64\n0 3 7\nCONNECTIVITY "
                                   "vtktypeint64\n0 1 2 0 1 3 2\nCELL_TYPES 2\n5\n8\nCELL_DATA 2\nrubbish\n");

  CHECK(elements_of(mesh, Shape::triangle3) == Connectivity(Eigen::Vector3i(0, 1, 2)));
  CHECK(elements_of(mesh, Shape::quadrilateral4) == Connectivity(Eigen::Vector4i(0, 1, 2, 3))); // a pixel
}

TEST_CASE("POLYDATA: points, lines, polygons, and strips whose triangles all turn the same way")
{
  const auto mesh = parse_vtk("m", poly + "VERTICES 1 2\n1 3\nLINES 1 4\n3 0 1 3\nPOLYGONS 1 5\n4 0 1 3 2\n"
                                          "TRIANGLE_STRIPS 1 5\n4 0 1 2 3\nPOINT_DATA 4\n");

  CHECK(elements_of(mesh, Shape::point1) == Connectivity::Constant(1, 1, 3));
  CHECK(elements_of(mesh, Shape::line2) == (Connectivity(2, 2) << 0, 1, 1, 3).finished());
  CHECK(elements_of(mesh, Shape::quadrilateral4) == Connectivity(Eigen::Vector4i(0, 1, 3, 2)));
  CHECK(elements_of(mesh, Shape::triangle3) == (Connectivity(3, 2) << 0, 2, 1, 1, 2, 3).finished());
  CHECK(contains(vtk_complaint(poly + "POLYGONS 1 6\n5 0 1 2 3 0\n"), "a polygon of 5 points"));
}

TEST_CASE("errors of VTK files say where, what, and what would be right")
{
  CHECK(vtk_complaint(legacy) == "");
  CHECK(vtk_complaint("") == "m:1: another first line; \"# vtk DataFile Version 3.0\" or alike");
  CHECK(vtk_complaint(replaced(legacy, "UNSTRUCTURED_GRID", "RECTILINEAR_GRID")) ==
        "m:4: a data set RECTILINEAR_GRID; POLYDATA or UNSTRUCTURED_GRID");
  CHECK(contains(vtk_complaint(replaced(legacy, "CELL_TYPES 1\n5", "CELL_TYPES 1\n22")),
                 "a cell of type 22 (VTK_QUADRATIC_TRIANGLE) with 3 points; cells are linear"));
  CHECK(vtk_complaint(replaced(legacy, "3 0 1 2", "3 0 1 4")) ==
        "m:10: a cell with the point 4; points are 0 to 4 - 1");
  CHECK(contains(vtk_complaint(replaced(legacy, "3 0 1 2", "9 0 1 2")), "cell 0 goes beyond the end"));
  CHECK(contains(vtk_complaint(replaced(legacy, "POINTS 4", "POINTS 400000000000")), "400000000000, but only"));

  const auto vtu = vtu_text(box_2d({1, 1, Cells::quads, {}}, {1, 1}));
  CHECK(vtu_complaint(vtu) == "");
  CHECK(contains(vtu_complaint(replaced(vtu, "NumberOfPoints=\"4\"", "NumberOfPoints=\"5\"")),
                 "m:6 (Points): 12 coordinates in 3 components; 3 components for each of 5 points"));
  CHECK(contains(vtu_complaint(replaced(vtu, "Name=\"types\"", "Name=\"kinds\"")),
                 "Cells without a DataArray \"types\"; one is needed"));
  CHECK(contains(vtu_complaint(replaced(vtu, "header_type", "compressor=\"vtkLZ4DataCompressor\" header_type")),
                 "the compressor vtkLZ4DataCompressor; vtkZLibDataCompressor or none"));
  CHECK(contains(vtu_complaint(replaced(vtu, "type=\"UnstructuredGrid\"", "type=\"PolyData\"")),
                 "a file of type \"PolyData\"; UnstructuredGrid"));
  CHECK(contains(vtu_complaint(vtu.substr(0, vtu.size() / 2)), "the XML of a VTU file"));
}
