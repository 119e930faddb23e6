// The XML format. Raw appended data are no XML: the text up to them is parsed, and they are looked up by themselves.
#include "file_error.hpp"
#include "raw_mesh.hpp"
#include "scanner.hpp"
#include "vtk.hpp"
#include "vtk_cells.hpp"
#include "vtu_arrays.hpp"

#include <pugixml.hpp>

#include <algorithm>
#include <cstring>

namespace mullion::mesh_files {
namespace {

/// Find the appended data, and return the text without them.
std::string split_off_appended(VtuFile& file)
{
  const auto element = file.bytes.find("<AppendedData");
  if (element == std::string_view::npos) return std::string(file.bytes);
  const auto head_end = file.bytes.find('>', element);
  const auto begin = head_end == std::string_view::npos ? head_end : file.bytes.find('_', head_end);
  if (begin == std::string_view::npos)
    throw FileError(join(file.name, ": appended data without their '_'; the file is cut off or damaged"));
  const auto head = file.bytes.substr(element, head_end - element);
  file.is_appended_raw = head.find("raw") != std::string_view::npos;
  file.appended = file.bytes.substr(begin + 1);
  if (!file.is_appended_raw) { // base64, one text after the other; each array says where it begins
    file.appended = file.appended.substr(0, file.appended.find('<'));
    while (!file.appended.empty() && std::strchr(" \n\r\t", file.appended.back()) != nullptr)
      file.appended.remove_suffix(1);
  }
  return join(file.bytes.substr(0, element), "</VTKFile>");
}

pugi::xml_node child(const VtuFile& file, const pugi::xml_node& parent, const char* name)
{
  const auto node = parent.child(name);
  if (!node) file.fail(parent, join("a ", parent.name(), " without ", name), "one is needed");
  return node;
}

pugi::xml_node array_called(const VtuFile& file, const pugi::xml_node& parent, const char* name)
{
  const auto array = parent.find_child_by_attribute("DataArray", "Name", name);
  if (!array) file.fail(parent, join(parent.name(), " without a DataArray \"", name, '"'), "one is needed");
  return array;
}

/// An attribute that counts things; 0 if it is left out.
std::size_t count(const VtuFile& file, const pugi::xml_node& node, const char* attribute)
{
  std::int64_t n = 0;
  const char* text = node.attribute(attribute).as_string("0");
  if (!to_number(text, n) || n < 0)
    file.fail(node, join(attribute, " = \"", shown(text), '"'), "a number that is not negative");
  return static_cast<std::size_t>(n);
}

void read_format(VtuFile& file, const pugi::xml_node& root)
{
  const auto says = [&](const char* attribute, const char* value) {
    return std::strcmp(root.attribute(attribute).value(), value) == 0;
  };
  if (!says("type", "UnstructuredGrid"))
    file.fail(root, join("a file of type \"", shown(root.attribute("type").value()), '"'), "UnstructuredGrid");
  if (!says("byte_order", "LittleEndian") && !says("byte_order", "BigEndian") && !says("byte_order", ""))
    file.fail(root, "another byte_order", "LittleEndian or BigEndian");
  if (!says("header_type", "") && !says("header_type", "UInt32") && !says("header_type", "UInt64"))
    file.fail(root, "another header_type", "UInt32 or UInt64");
  if (!says("compressor", "") && !says("compressor", "vtkZLibDataCompressor"))
    file.fail(root, join("the compressor ", shown(root.attribute("compressor").value())),
              "vtkZLibDataCompressor or none");
  file.is_swapped = says("byte_order", "") ? false : says("byte_order", "LittleEndian") != is_little_endian();
  file.header = says("header_type", "UInt64") ? Number::u64 : Number::u32;
  file.is_compressed = says("compressor", "vtkZLibDataCompressor");
}

/// Cell arrays that mark groups.
void read_groups(const VtuFile& file, const pugi::xml_node& piece, RawMesh& raw, const std::vector<Element>& cells)
{
  for (const auto& array : piece.child("CellData").children("DataArray")) {
    const std::string name = array.attribute("Name").value();
    if (name.rfind(group_prefix, 0) != 0) continue;
    const auto marks = read_integers(file, array);
    if (marks.size() != cells.size())
      file.fail(array, join(marks.size(), " marks of a group"), join("one a cell: ", cells.size()));
    for (std::size_t c = 0; c < cells.size(); ++c)
      if (marks[c] != 0) add_to_group(raw, name.substr(std::strlen(group_prefix)), cells[c]);
  }
}

void read_piece(const VtuFile& file, const pugi::xml_node& piece, RawMesh& raw)
{
  const auto n_points = count(file, piece, "NumberOfPoints"), n_cells = count(file, piece, "NumberOfCells");
  const auto first = static_cast<std::int64_t>(n_nodes(raw));
  if (n_points == 0 && n_cells == 0) return;
  const auto points = child(file, child(file, piece, "Points"), "DataArray");
  const auto coordinates = read_reals(file, points);
  if (count(file, points, "NumberOfComponents") != 3 || coordinates.size() % 3 != 0 ||
      coordinates.size() / 3 != n_points)
    file.fail(points,
              join(coordinates.size(), " coordinates in ", count(file, points, "NumberOfComponents"), " components"),
              join("3 components for each of ", n_points, " points"));
  add_vtk_points(raw, coordinates);

  const auto cells = child(file, piece, "Cells");
  const auto nodes = read_integers(file, array_called(file, cells, "connectivity"));
  const auto offsets = read_integers(file, array_called(file, cells, "offsets"));
  const auto types = read_integers(file, array_called(file, cells, "types"));
  if (offsets.size() != n_cells || types.size() != n_cells)
    file.fail(cells, join(offsets.size(), " offsets and ", types.size(), " types"), join("one a cell: ", n_cells));
  const Fail fail = [&](const std::string& found, const std::string& right) { file.fail(cells, found, right); };
  std::vector<Element> elements;
  std::vector<std::int64_t> of_cell;
  std::int64_t begin = 0;
  for (std::size_t c = 0; c < n_cells; ++c) {
    if (offsets[c] < begin || offsets[c] > static_cast<std::int64_t>(nodes.size()))
      fail(join("cell ", c, " ends at the offset ", offsets[c]), join("offsets grow up to ", nodes.size()));
    of_cell.assign(nodes.begin() + begin, nodes.begin() + offsets[c]);
    for (auto& node : of_cell) {
      if (node < 0 || node >= static_cast<std::int64_t>(n_points))
        fail(join("cell ", c, " has the point ", node), join("points are 0 to ", n_points, " - 1"));
      node += first;
    }
    elements.push_back(add_vtk_cell(raw, types[c], of_cell, fail));
    begin = offsets[c];
  }
  read_groups(file, piece, raw, elements);
}

} // namespace

MeshFile parse_vtu(const std::string& name, std::string_view bytes, int dimension)
{
  VtuFile file{.name = name, .bytes = bytes, .appended = {}};
  const auto text = split_off_appended(file);
  pugi::xml_document document;
  const auto outcome = document.load_buffer(text.data(), text.size());
  if (!outcome) {
    const auto end = text.begin() + std::min(outcome.offset, static_cast<std::ptrdiff_t>(text.size()));
    throw FileError(join(name, ':', 1 + std::count(text.begin(), end, '\n'), ": ", outcome.description(),
                         "; the XML of a VTU file"));
  }
  const auto root = document.child("VTKFile");
  if (!root) throw FileError(join(name, ": XML without a VTKFile; a VTU file is one"));
  read_format(file, root);
  RawMesh raw;
  for (const auto& piece : child(file, root, "UnstructuredGrid").children("Piece")) read_piece(file, piece, raw);
  try {
    return finished(std::move(raw), dimension);
  } catch (const FileError& error) {
    throw FileError(join(name, ": ", error.what()));
  }
}

} // namespace mullion::mesh_files
