// Lists of groups to numbered patches.
#include "patches.hpp"

#include "mesh_input.hpp"

#include <algorithm>

namespace mullion::euler {

Patches patches_of(const PatchTexts& texts)
{
  Patches patches;
  const auto add = [&](const std::string& name, Kind kind) {
    if (std::find(patches.names.begin(), patches.names.end(), name) != patches.names.end())
      throw MeshError("group \"" + name + "\" has two conditions; a boundary face has one");
    patches.names.push_back(name);
    patches.kinds.push_back(kind);
  };
  const auto add_all = [&](const std::string& text, Kind kind) {
    for (const auto& name : names_in(text)) add(name, kind);
  };
  add_all(texts.moving_wall, Kind::wall);
  patches.n_moving = static_cast<int>(patches.names.size());
  add_all(texts.slip_wall, Kind::wall);
  add_all(texts.symmetry, Kind::wall);
  add_all(texts.farfield, Kind::far_field);
  add_all(texts.prescribed, Kind::prescribed);
  add_all(texts.subsonic_inflow, Kind::subsonic_inflow);
  add_all(texts.subsonic_outflow, Kind::subsonic_outflow);
  add_all(texts.supersonic_inflow, Kind::supersonic_inflow);
  add_all(texts.supersonic_outflow, Kind::supersonic_outflow);
  for (const auto& [first, second] : pairs_in(texts.periodic)) {
    const auto number = static_cast<int>(patches.names.size());
    add(first, Kind::wall); // no face keeps it
    add(second, Kind::wall);
    patches.periodic.push_back({number, number + 1});
  }
  return patches;
}

std::vector<Index> group_bits(const Mesh<2>& mesh, const std::vector<std::string>& names, std::size_t n_nodes)
{
  auto sorted = names;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Index> bits(n_nodes, 0);
  for (const auto& face : mesh.boundary) {
    const auto& name = names[static_cast<std::size_t>(face.patch)];
    const auto k = std::lower_bound(sorted.begin(), sorted.end(), name) - sorted.begin();
    if (k > 30) continue;
    for (const Index node : mesh.face_nodes[static_cast<std::size_t>(face.face)])
      bits[static_cast<std::size_t>(node)] |= Index{1} << k;
  }
  return bits;
}

} // namespace mullion::euler
