#include "body.hpp"

#include "files/file_error.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace mullion::elastic_solid {
namespace {

using mesh_files::FileError;
using mesh_files::join;
using mesh_files::MeshFile;

Eigen::VectorX<Index> nodes_of_element(const MeshFile& mesh, const mesh_files::Element& element)
{
  return mesh.blocks[static_cast<std::size_t>(element.block)].connectivity.col(element.column);
}

std::vector<Index> sorted(const Eigen::VectorX<Index>& nodes)
{
  std::vector<Index> out(nodes.begin(), nodes.end());
  std::sort(out.begin(), out.end());
  return out;
}

/// find_group, with an error that begins with the key.
const mesh_files::Group& group_of(const MeshFile& mesh, const char* key, const std::string& name, int dimension)
{
  try {
    return mesh_files::find_group(mesh, name, dimension);
  } catch (const FileError& error) {
    throw FileError(join(key, ": ", error.what()));
  }
}

/// The faces of the solid that the elements of groups are.
std::vector<FaceOf> faces_of(const MeshFile& mesh, const std::map<std::vector<Index>, FaceOf>& boundary,
                             const char* key, const std::string& text)
{
  std::vector<FaceOf> faces;
  std::set<std::vector<Index>> taken; // a face may be in several groups
  for (const auto& name : names_in(text))
    for (const auto& element : group_of(mesh, key, name, mesh.dimension - 1).elements) {
      const auto nodes = nodes_of_element(mesh, element);
      const auto found = boundary.find(sorted(nodes));
      const Index first = nodes[0], last = nodes[nodes.size() - 1];
      if (found == boundary.end())
        throw FileError(join(key, ": the element of group \"", name, "\" from node ", first, " at ",
                             place(mesh.nodes.col(first)), " to node ", last, " at ", place(mesh.nodes.col(last)),
                             " is no face on the boundary of the solid's elements"));
      if (taken.insert(found->first).second) faces.push_back(found->second);
    }
  return faces;
}

void hold(const MeshFile& mesh, const char* key, const std::string& text, Index bits,
          Eigen::VectorX<Index>& constraints)
{
  for (const auto& name : names_in(text))
    for (const auto& element : group_of(mesh, key, name, -1).elements)
      for (const Index node : nodes_of_element(mesh, element)) constraints[node] |= bits;
}

std::vector<mesh_files::Block> blocks_of(const Surface& surface, const std::vector<Index>& nodes)
{
  std::vector<mesh_files::Block> blocks;
  for (const auto shape : {Shape::line2, Shape::triangle3, Shape::quadrilateral4}) {
    const auto n_faces = std::count(surface.shapes.begin(), surface.shapes.end(), shape);
    if (n_faces == 0) continue;
    mesh_files::Connectivity faces(mesh_files::facts(shape).n_nodes, n_faces);
    Eigen::Index column = 0;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) {
      if (surface.shapes[f] != shape) continue;
      for (Eigen::Index a = 0; a < faces.rows(); ++a)
        faces(a, column) =
            static_cast<Index>(std::lower_bound(nodes.begin(), nodes.end(), surface.faces[f][a]) - nodes.begin());
      ++column;
    }
    blocks.push_back({shape, faces});
  }
  return blocks;
}

} // namespace

std::vector<std::string> names_in(const std::string& text)
{
  std::vector<std::string> names;
  std::size_t begin = 0;
  while (begin <= text.size()) {
    const auto end = std::min(text.find(',', begin), text.size());
    auto name = text.substr(begin, end - begin);
    name.erase(0, std::min(name.find_first_not_of(" \t"), name.size()));
    name.erase(name.find_last_not_of(" \t") + 1);
    if (!name.empty()) names.push_back(name);
    begin = end + 1;
  }
  return names;
}

Body body_of(const MeshFile& mesh, const GroupTexts& groups)
{
  Solid solid;
  solid.nodes = mesh.nodes;
  for (const auto& block : mesh.blocks)
    if (mesh_files::facts(block.shape).dimension == mesh.dimension) solid.blocks.push_back(block);
  if (const auto complaint = complaint_about(solid); !complaint.empty()) throw FileError(complaint);
  if (mesh.dimension < 3 && !names_in(groups.roller_z).empty())
    throw FileError("roller_z: the mesh lies in the plane; there is no z");

  Body body{solid.nodes,
            solid.blocks,
            {},
            {},
            Eigen::VectorX<Index>::Zero(solid.n_nodes()),
            Eigen::VectorX<Index>::Zero(n_elements(solid))};
  std::map<std::vector<Index>, FaceOf> boundary; // by the sorted nodes of a face
  const auto all = surface_of(solid, boundary_faces(solid));
  for (std::size_t f = 0; f < all.faces.size(); ++f) boundary[sorted(all.faces[f])] = all.owners[f];

  const auto wet = surface_of(solid, faces_of(mesh, boundary, "wet", groups.wet));
  if (wet.faces.empty()) throw FileError("wet: it names no face; a fluid needs a surface to load");
  body.wet_nodes = nodes_of(wet);
  body.wet = blocks_of(wet, body.wet_nodes);
  for (const auto& [element, local] : faces_of(mesh, boundary, "edge_load", groups.edge_load))
    body.loaded_faces[element] |= 1 << local;

  hold(mesh, "clamped", groups.clamped, mesh.dimension == 2 ? 1 | 2 : 1 | 2 | 4, body.constraints);
  hold(mesh, "roller_x", groups.roller_x, held_bits[0], body.constraints);
  hold(mesh, "roller_y", groups.roller_y, held_bits[1], body.constraints);
  hold(mesh, "roller_z", groups.roller_z, held_bits[2], body.constraints);
  hold(mesh, "prescribed", groups.prescribed, prescribed_bit, body.constraints);
  return body;
}

std::vector<FaceOf> faces_in(const Eigen::VectorX<Index>& loaded_faces)
{
  std::vector<FaceOf> faces;
  for (Eigen::Index e = 0; e < loaded_faces.size(); ++e)
    for (int k = 0; k < 6; ++k) // no element has more faces
      if (((loaded_faces[e] >> k) & 1) != 0) faces.push_back({e, k});
  return faces;
}

} // namespace mullion::elastic_solid
