// Version 4.1 as text. Gmsh knows groups of entities only, so elements of one shape that are in the same groups make
// an entity.
#include "file_error.hpp"
#include "msh.hpp"
#include "text_number.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace mullion::mesh_files {
namespace {

/// Elements that are in the same groups.
struct Entity {
  int number = 0; ///< among those of its dimension
  std::vector<Element> elements;
};

/// By dimension, and then by the physical groups (numbered from 1 on, of all dimensions).
using Entities = std::map<std::pair<int, std::set<int>>, Entity>;

Entities entities_of(const MeshFile& mesh)
{
  std::map<Element, std::set<int>> groups;
  for (std::size_t g = 0; g < mesh.groups.size(); ++g)
    for (const auto& element : mesh.groups[g].elements) groups[element].insert(static_cast<int>(g) + 1);
  Entities entities;
  for (std::size_t b = 0; b < mesh.blocks.size(); ++b)
    for (Eigen::Index e = 0; e < mesh.blocks[b].connectivity.cols(); ++e) {
      const Element element{static_cast<Index>(b), static_cast<Index>(e)};
      const auto in = groups.find(element);
      entities[{facts(mesh.blocks[b].shape).dimension, in == groups.end() ? std::set<int>() : in->second}]
          .elements.push_back(element);
    }
  std::array<int, 4> n{};
  for (auto& [key, entity] : entities) entity.number = ++n[static_cast<std::size_t>(key.first)];
  return entities;
}

Eigen::Vector3d point(const MeshFile& mesh, Eigen::Index node)
{
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  x.head(mesh.nodes.rows()) = mesh.nodes.col(node);
  return x;
}

void append_entities(std::string& text, const MeshFile& mesh, const Entities& entities)
{
  std::array<int, 4> n{};
  for (const auto& [key, entity] : entities) ++n[static_cast<std::size_t>(key.first)];
  text += "$Entities\n";
  for (int d = 0; d < 4; ++d) append(text, n[static_cast<std::size_t>(d)], d == 3 ? '\n' : ' ');
  Eigen::Vector3d low = point(mesh, 0), high = low;
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    low = low.cwiseMin(point(mesh, i));
    high = high.cwiseMax(point(mesh, i));
  }
  for (const auto& [key, entity] : entities) {
    append(text, entity.number, ' ');
    for (const double x : low) append(text, x, ' ');
    for (const double x : high)
      if (key.first > 0) append(text, x, ' ');
    append(text, key.second.size(), ' ');
    for (const int group : key.second) append(text, group, ' ');
    text += key.first > 0 ? "0\n" : "\n"; // bounded by no other entity that we know of
  }
  text += "$EndEntities\n";
}

void append_head(std::string& text, std::size_t n_blocks, Eigen::Index n)
{
  append(text, n_blocks, ' ');
  append(text, n, ' ');
  append(text, 1, ' ');
  append(text, n, '\n');
}

void append_nodes(std::string& text, const MeshFile& mesh, const Entities& entities)
{
  const auto& [key, entity] = *entities.rbegin(); // any entity will do: one of the largest dimension
  const auto n = mesh.nodes.cols();
  text += "$Nodes\n";
  append_head(text, 1, n);
  append(text, key.first, ' ');
  append(text, entity.number, ' ');
  append(text, 0, ' ');
  append(text, n, '\n');
  for (Eigen::Index i = 1; i <= n; ++i) append(text, i, '\n');
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto x = point(mesh, i);
    for (int k = 0; k < 3; ++k) append(text, x[k], k == 2 ? '\n' : ' ');
  }
  text += "$EndNodes\n";
}

void append_elements(std::string& text, const MeshFile& mesh, const Entities& entities)
{
  std::string body;
  Eigen::Index n = 0;
  std::size_t n_blocks = 0;
  for (const auto& [key, entity] : entities)
    for (std::size_t b = 0; b < mesh.blocks.size(); ++b) {
      const auto is_here = [&](const Element& e) { return e.block == static_cast<Index>(b); };
      const auto n_here = std::count_if(entity.elements.begin(), entity.elements.end(), is_here);
      if (n_here == 0) continue;
      ++n_blocks;
      append(body, key.first, ' ');
      append(body, entity.number, ' ');
      append(body, facts(mesh.blocks[b].shape).gmsh_type, ' ');
      append(body, n_here, '\n');
      for (const auto& element : entity.elements) {
        if (!is_here(element)) continue;
        append(body, ++n, ' ');
        for (const auto node : mesh.blocks[b].connectivity.col(element.column)) append(body, node + 1, ' ');
        body.back() = '\n';
      }
    }
  text += "$Elements\n";
  append_head(text, n_blocks, n);
  text += body + "$EndElements\n";
}

} // namespace

std::string msh_text(const MeshFile& mesh)
{
  const auto entities = entities_of(mesh);
  if (entities.empty()) throw FileError("a mesh without elements cannot be written");
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n";
  if (!mesh.groups.empty()) {
    text += "$PhysicalNames\n";
    append(text, mesh.groups.size(), '\n');
    for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
      if (mesh.groups[g].name.find_first_of("\"\n\r") != std::string::npos)
        throw FileError(join("a group is called ", mesh.groups[g].name, "; names have neither quotes nor line breaks"));
      append(text, mesh.groups[g].dimension, ' ');
      append(text, g + 1, ' ');
      text += '"' + mesh.groups[g].name + "\"\n";
    }
    text += "$EndPhysicalNames\n";
  }
  append_entities(text, mesh, entities);
  append_nodes(text, mesh, entities);
  append_elements(text, mesh, entities);
  return text;
}

} // namespace mullion::mesh_files
