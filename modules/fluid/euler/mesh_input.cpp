// Matches the elements of boundary groups with the faces of cells.
#include "mesh_input.hpp"

#include "files/file_error.hpp"

#include <algorithm>
#include <set>

namespace mullion::euler {

namespace {

using Key = std::array<Index, 4>;

Key key_of(const Connectivity& connectivity, Eigen::Index column)
{
  Key key{-1, -1, -1, -1};
  for (Eigen::Index k = 0; k < connectivity.rows(); ++k) key[static_cast<std::size_t>(k)] = connectivity(k, column);
  std::sort(key.begin(), key.end());
  return key;
}

std::string trimmed(const std::string& text)
{
  const auto first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// A cell's face, by its nodes.
struct KeyedFace {
  Key key{};
  CellFace at;
};

std::string groups_text(const mesh_files::MeshFile& file, int dimension)
{
  std::string text;
  for (const auto& group : file.groups)
    if (group.dimension == dimension) text += (text.empty() ? "" : ", ") + group.name;
  return text.empty() ? "none" : text;
}

template <int D> std::string at_face(const MeshSource<D>& source, const Key& key)
{
  Vec<D> sum = Vec<D>::Zero();
  int n = 0;
  for (const Index node : key)
    if (node >= 0) {
      sum += source.nodes.col(node);
      ++n;
    }
  std::string text = "(" + std::to_string(sum[0] / n);
  for (int d = 1; d < D; ++d) text += ", " + std::to_string(sum[d] / n);
  return text + ") m";
}

template <int D> std::vector<KeyedFace> boundary_faces(const MeshSource<D>& source)
{
  std::vector<KeyedFace> faces;
  Index cell = 0;
  for (const auto& block : source.blocks) {
    const auto& shape = faces_of(block.shape, D);
    for (Eigen::Index e = 0; e < block.connectivity.cols(); ++e, ++cell)
      for (int f = 0; f < shape.n_faces; ++f) {
        Key key{-1, -1, -1, -1};
        for (std::size_t k = 0; k < 4; ++k) {
          const int local = shape.nodes[static_cast<std::size_t>(f)][k];
          if (local >= 0) key[k] = block.connectivity(local, e);
        }
        std::sort(key.begin(), key.end());
        faces.push_back({key, {cell, f}});
      }
  }
  std::sort(faces.begin(), faces.end(), [](const KeyedFace& l, const KeyedFace& r) { return l.key < r.key; });
  std::vector<KeyedFace> alone;
  for (std::size_t i = 0; i < faces.size();) {
    std::size_t end = i + 1;
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end == i + 1) alone.push_back(faces[i]);
    i = end;
  }
  return alone;
}

} // namespace

std::vector<std::string> names_in(const std::string& text)
{
  std::vector<std::string> names;
  if (trimmed(text).empty()) return names;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto comma = std::min(text.find(',', begin), text.size());
    names.push_back(trimmed(text.substr(begin, comma - begin)));
    if (names.back().empty())
      throw MeshError("\"" + text + "\": a name is missing; expected names with commas between");
    begin = comma + 1;
  }
  return names;
}

std::vector<std::pair<std::string, std::string>> pairs_in(const std::string& text)
{
  std::vector<std::pair<std::string, std::string>> pairs;
  for (const auto& part : names_in(text)) {
    const auto colon = part.find(':');
    const auto first = colon == std::string::npos ? "" : trimmed(part.substr(0, colon));
    const auto second = colon == std::string::npos ? "" : trimmed(part.substr(colon + 1));
    if (first.empty() || second.empty())
      throw MeshError("\"" + part + "\": expected two groups with a colon between, as x_min:x_max");
    pairs.emplace_back(first, second);
  }
  return pairs;
}

template <int D> MeshSource<D> source_of(const mesh_files::MeshFile& file, const std::vector<std::string>& patches)
{
  if (file.dimension != D)
    throw MeshError("the mesh has " + std::to_string(file.dimension) + " dimensions, expected " + std::to_string(D));
  MeshSource<D> source;
  source.nodes = file.nodes;
  Eigen::Index n_cells = 0;
  for (const auto& block : file.blocks)
    if (mesh_files::facts(block.shape).dimension == D) {
      source.blocks.push_back(block);
      n_cells += block.connectivity.cols();
    }
  source.patch_of_face.setConstant(most_cell_faces<D>, n_cells, -1);

  const auto faces = boundary_faces(source);
  std::vector<int> patch(faces.size(), -1);
  const auto find = [&](const Key& key) {
    const auto it = std::lower_bound(faces.begin(), faces.end(), key,
                                     [](const KeyedFace& face, const Key& k) { return face.key < k; });
    return it != faces.end() && it->key == key ? static_cast<std::ptrdiff_t>(it - faces.begin()) : -1;
  };
  for (std::size_t p = 0; p < patches.size(); ++p) {
    const mesh_files::Group* group = nullptr;
    for (const auto& g : file.groups)
      if (g.name == patches[p] && g.dimension == D - 1) group = &g;
    if (group == nullptr)
      throw MeshError("the mesh has no boundary group \"" + patches[p] + "\"; there are: " + groups_text(file, D - 1));
    for (const auto& element : group->elements) {
      const auto key = key_of(file.blocks[static_cast<std::size_t>(element.block)].connectivity, element.column);
      const auto i = find(key);
      if (i < 0)
        throw MeshError("group \"" + patches[p] + "\": its element at " + at_face(source, key) +
                        " is not on the boundary of the mesh");
      auto& its = patch[static_cast<std::size_t>(i)];
      if (its >= 0 && its != static_cast<int>(p))
        throw MeshError("the boundary face at " + at_face(source, key) + " is in two groups with a condition, \"" +
                        patches[static_cast<std::size_t>(its)] + "\" and \"" + patches[p] + "\"");
      its = static_cast<int>(p);
    }
  }
  std::size_t n_without = 0, first = 0;
  for (std::size_t i = faces.size(); i-- > 0;) {
    source.patch_of_face(faces[i].at.face, faces[i].at.cell) = patch[i];
    if (patch[i] < 0) {
      ++n_without;
      first = i;
    }
  }
  if (n_without > 0) {
    std::set<std::string> names; // groups that they are in
    for (const auto& g : file.groups) {
      if (g.dimension != D - 1) continue;
      for (const auto& element : g.elements) {
        const auto i = find(key_of(file.blocks[static_cast<std::size_t>(element.block)].connectivity, element.column));
        if (i >= 0 && patch[static_cast<std::size_t>(i)] < 0) names.insert(g.name);
      }
    }
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    throw MeshError(std::to_string(n_without) + " boundary faces have no condition, the first at " +
                    at_face(source, faces[first].key) +
                    (text.empty() ? "; they are in no group of the mesh" : "; they are in the groups: " + text));
  }
  return source;
}

template MeshSource<2> source_of<2>(const mesh_files::MeshFile&, const std::vector<std::string>&);
template MeshSource<3> source_of<3>(const mesh_files::MeshFile&, const std::vector<std::string>&);

} // namespace mullion::euler
