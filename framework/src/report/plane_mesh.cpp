#include "report/plane_mesh.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace mullion::report {
namespace {

void read_block(const io::ImageReader& mesh, const std::string& path, const std::string& source, PlanePane& pane,
                std::size_t first)
{
  const auto element = mesh.text_attribute(path, "element");
  const std::size_t n = element == "triangle3" ? 3 : element == "quadrilateral4" ? 4 : 0;
  if (n == 0) return;
  const auto nodes = mesh.i32(path);
  for (std::size_t e = 0; n * e < nodes.size(); ++e) {
    PlaneElement& added = pane.elements.emplace_back();
    added.n_nodes = n;
    added.number = first + e;
    for (std::size_t c = 0; c < n; ++c) {
      const auto node = nodes[n * e + c];
      MULLION_REQUIRE(0 <= node && static_cast<std::size_t>(node) < pane.reference.size(), Errc::io,
                      "{}:{}: element {} refers to node {}, but there are {}", source, path, e, node,
                      pane.reference.size());
      added.nodes[c] = static_cast<std::size_t>(node);
    }
  }
}

PlanePane read_pane(const io::ImageReader& mesh, const std::string& group, const std::string& source)
{
  PlanePane pane;
  pane.group = group;
  const auto path = group + "/reference_coordinates";
  const auto xy = mesh.f64(path);
  const auto n_nodes = static_cast<std::size_t>(mesh.i64_attribute(group, "n_nodes"));
  MULLION_REQUIRE(xy.size() == 2 * n_nodes, Errc::io, "{}:{}: {} numbers, expected two for each of {} nodes", source,
                  path, xy.size(), n_nodes);
  for (std::size_t i = 0; i < n_nodes; ++i) pane.reference.push_back({xy[2 * i], xy[2 * i + 1]});
  std::size_t n_before = 0;
  for (std::size_t b = 0; mesh.has(fmt::format("{}/connectivity_{}", group, b)); ++b) {
    const auto block = fmt::format("{}/connectivity_{}", group, b);
    read_block(mesh, block, source, pane, n_before);
    n_before += static_cast<std::size_t>(mesh.extents(block).at(0));
  }
  return pane;
}

} // namespace

std::vector<PlaneWindow> read_plane_windows(const io::ImageReader& mesh, const std::string& source)
{
  std::vector<PlaneWindow> windows;
  for (const auto& instance : mesh.names("/"))
    for (const auto& name : mesh.names("/" + instance)) {
      PlaneWindow window;
      window.name = instance + "." + name;
      const auto folder = fmt::format("/{}/{}", instance, name);
      for (const auto& pane : mesh.names(folder)) {
        const auto group = folder + "/" + pane;
        if (mesh.i64_attribute(group, "dimension") != 2) continue;
        if (auto read = read_pane(mesh, group, source); !read.elements.empty()) window.panes.push_back(std::move(read));
      }
      if (!window.panes.empty()) windows.push_back(std::move(window));
    }
  return windows;
}

double extent(const PlaneWindow& window)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Point low{infinity, infinity}, high{-infinity, -infinity};
  for (const auto& pane : window.panes)
    for (const auto& node : pane.reference) {
      low = {std::min(low.x, node.x), std::min(low.y, node.y)};
      high = {std::max(high.x, node.x), std::max(high.y, node.y)};
    }
  return std::max(high.x - low.x, high.y - low.y);
}

std::vector<std::array<std::size_t, 2>> boundary_edges(const PlanePane& pane)
{
  std::vector<std::array<std::size_t, 2>> edges;
  for (const auto& element : pane.elements)
    for (std::size_t c = 0; c < element.n_nodes; ++c) {
      const auto a = element.nodes[c], b = element.nodes[(c + 1) % element.n_nodes];
      edges.push_back({std::min(a, b), std::max(a, b)});
    }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<std::size_t, 2>> once;
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end] == edges[begin]) ++end;
    if (end - begin == 1) once.push_back(edges[begin]);
  }
  return once;
}

} // namespace mullion::report
