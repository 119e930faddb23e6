// The XML format as text, with a cell array for each group.
#include "file_error.hpp"
#include "text_number.hpp"
#include "vtk.hpp"
#include "vtk_cells.hpp"

namespace mullion::mesh_files {
namespace {

/// A name as the value of an attribute.
std::string escaped(const std::string& name)
{
  std::string out;
  for (const char c : name) {
    if (c == '&') out += "&amp;";
    else if (c == '<') out += "&lt;";
    else if (c == '"') out += "&quot;";
    else if (static_cast<unsigned char>(c) < ' ')
      throw FileError(join("a group is called ", name, "; names have no control characters"));
    else out += c;
  }
  return out;
}

void open_array(std::string& text, const char* type, const std::string& name)
{
  text += "<DataArray type=\"" + std::string(type) + "\" Name=\"" + name + "\" format=\"ascii\">\n";
}

void append_points(std::string& text, const MeshFile& mesh)
{
  text += "<Points>\n<DataArray type=\"Float64\" Name=\"Points\" NumberOfComponents=\"3\" format=\"ascii\">\n";
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k)
      append(text, k < mesh.nodes.rows() ? mesh.nodes(k, i) : 0.0, k == 2 ? '\n' : ' ');
  text += "</DataArray>\n</Points>\n";
}

void append_cells(std::string& text, const MeshFile& mesh)
{
  text += "<Cells>\n";
  open_array(text, "Int64", "connectivity");
  for (const auto& block : mesh.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) {
      for (std::size_t k = 0; k < static_cast<std::size_t>(block.connectivity.rows()); ++k) {
        const auto row = block.shape == Shape::prism6 ? vtk_wedge_order[k] : k;
        append(text, block.connectivity(static_cast<Eigen::Index>(row), e), ' ');
      }
      text.back() = '\n';
    }
  text += "</DataArray>\n";
  open_array(text, "Int64", "offsets");
  Eigen::Index end = 0;
  for (const auto& block : mesh.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) append(text, end += block.connectivity.rows(), '\n');
  text += "</DataArray>\n";
  open_array(text, "UInt8", "types");
  for (const auto& block : mesh.blocks)
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e) append(text, facts(block.shape).vtk_type, '\n');
  text += "</DataArray>\n</Cells>\n";
}

void append_groups(std::string& text, const MeshFile& mesh)
{
  text += "<CellData>\n";
  for (const auto& group : mesh.groups) {
    std::vector<std::vector<bool>> marks;
    for (const auto& block : mesh.blocks) marks.emplace_back(static_cast<std::size_t>(block.connectivity.cols()));
    for (const auto& [block, column] : group.elements)
      marks[static_cast<std::size_t>(block)][static_cast<std::size_t>(column)] = true;
    open_array(text, "UInt8", escaped(group_prefix + group.name));
    for (const auto& block : marks)
      for (const bool mark : block) append(text, mark ? 1 : 0, '\n');
    text += "</DataArray>\n";
  }
  text += "</CellData>\n";
}

} // namespace

std::string vtu_text(const MeshFile& mesh)
{
  Eigen::Index n_cells = 0;
  for (const auto& block : mesh.blocks) n_cells += block.connectivity.cols();
  std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                     "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n";
  text += join("<Piece NumberOfPoints=\"", mesh.nodes.cols(), "\" NumberOfCells=\"", n_cells, "\">\n");
  append_points(text, mesh);
  append_cells(text, mesh);
  append_groups(text, mesh);
  return text + "</Piece>\n</UnstructuredGrid>\n</VTKFile>\n";
}

} // namespace mullion::mesh_files
