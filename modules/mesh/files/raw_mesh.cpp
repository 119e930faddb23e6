#include "raw_mesh.hpp"

#include "file_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mullion::mesh_files {

Element add_element(RawMesh& raw, Shape shape, std::span<const Index> nodes)
{
  auto& connectivity = raw.connectivity[static_cast<std::size_t>(shape)];
  if (connectivity.empty()) raw.shapes.push_back(shape);
  const auto column = connectivity.size() / nodes.size();
  if (column >= static_cast<std::size_t>(std::numeric_limits<Index>::max()))
    throw FileError(join("the mesh has more than ", column, " elements of shape ", facts(shape).name,
                         "; that many cannot be numbered"));
  connectivity.insert(connectivity.end(), nodes.begin(), nodes.end());
  return {static_cast<Index>(shape), static_cast<Index>(column)};
}

void add_to_group(RawMesh& raw, const std::string& name, Element element)
{
  const int dimension = facts(static_cast<Shape>(element.block)).dimension;
  auto group = std::find_if(raw.groups.begin(), raw.groups.end(),
                            [&](const Group& g) { return g.dimension == dimension && g.name == name; });
  if (group == raw.groups.end()) group = raw.groups.insert(group, {name, dimension, {}});
  group->elements.push_back(element);
}

namespace {

/// The smallest space: the number of leading coordinates that are not 0 on all of these nodes, at least 1.
int smallest_dimension(const RawMesh& raw, const std::vector<Index>& used)
{
  int dimension = 1;
  for (const auto node : used)
    for (int k = dimension; k < 3; ++k)
      if (raw.coordinates[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(k)] != 0.0) dimension = k + 1;
  for (const auto shape : raw.shapes) dimension = std::max(dimension, facts(shape).dimension);
  return dimension;
}

void check_coordinates(const RawMesh& raw, const std::vector<Index>& used, int dimension)
{
  for (const auto node : used)
    for (int k = 0; k < 3; ++k) {
      const auto value = raw.coordinates[3 * static_cast<std::size_t>(node) + static_cast<std::size_t>(k)];
      const auto number = raw.numbers[static_cast<std::size_t>(node)];
      if (!std::isfinite(value))
        throw FileError(join("node ", number, " of the mesh has the coordinate ", "xyz"[k], " = ", value,
                             "; coordinates are finite numbers"));
      if (k >= dimension && value != 0.0)
        throw FileError(join("node ", number, " of the mesh has ", "xyz"[k], " = ", value, ", so it does not lie in ",
                             dimension, " dimensions; ask for ", k + 1));
    }
}

} // namespace

MeshFile finished(RawMesh raw, int dimension)
{
  if (raw.shapes.empty()) throw FileError("the mesh has no element; at least one is needed");
  std::vector<Index> new_node(n_nodes(raw), -1), used;
  for (const auto shape : raw.shapes)
    for (const auto node : raw.connectivity[static_cast<std::size_t>(shape)])
      new_node[static_cast<std::size_t>(node)] = 0;
  for (std::size_t node = 0; node < new_node.size(); ++node)
    if (new_node[node] == 0) {
      new_node[node] = static_cast<Index>(used.size());
      used.push_back(static_cast<Index>(node));
    }
  if (dimension == 0) dimension = smallest_dimension(raw, used);
  check_coordinates(raw, used, dimension);

  MeshFile mesh;
  mesh.dimension = dimension;
  mesh.nodes.resize(dimension, static_cast<Eigen::Index>(used.size()));
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto node = static_cast<std::size_t>(used[i]);
    for (int k = 0; k < dimension; ++k)
      mesh.nodes(k, static_cast<Eigen::Index>(i)) = raw.coordinates[3 * node + static_cast<std::size_t>(k)];
    mesh.node_numbers.push_back(raw.numbers[node]);
  }
  std::array<Index, n_shapes> block_of_shape{};
  for (const auto shape : raw.shapes) {
    const auto& nodes = raw.connectivity[static_cast<std::size_t>(shape)];
    const auto rows = facts(shape).n_nodes;
    Connectivity connectivity(rows, static_cast<Eigen::Index>(nodes.size()) / rows);
    std::transform(nodes.begin(), nodes.end(), connectivity.data(),
                   [&](Index node) { return new_node[static_cast<std::size_t>(node)]; });
    block_of_shape[static_cast<std::size_t>(shape)] = static_cast<Index>(mesh.blocks.size());
    mesh.blocks.push_back({shape, std::move(connectivity)});
  }
  for (auto& group : raw.groups) {
    for (auto& element : group.elements) element.block = block_of_shape[static_cast<std::size_t>(element.block)];
    mesh.groups.push_back(std::move(group));
  }
  return mesh;
}

} // namespace mullion::mesh_files
