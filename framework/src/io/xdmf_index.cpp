#include "io/xdmf_index.hpp"

#include <mullion/sdk/error.hpp>

#include <array>
#include <iterator>
#include <utility>

namespace mullion::io {
namespace {

// what is left open in a layout; no XML text holds these bytes
constexpr char step_mark = '\x01';
constexpr char time_mark = '\x02';

constexpr std::string_view head = R"(<?xml version="1.0" encoding="UTF-8"?>
<Xdmf Version="3.0">
<Domain>
<Grid Name="results" GridType="Collection" CollectionType="Temporal">
)";
constexpr std::string_view tail = "</Grid>\n</Domain>\n</Xdmf>\n";
constexpr std::string_view output_begin = "<Grid Name=\"\x01\" GridType=\"Collection\" CollectionType=\"Spatial\">\n"
                                          "<Time Value=\"\x02\"/>\n";
constexpr std::string_view output_end = "</Grid> <!-- output -->\n";

struct Shape {
  std::string_view name;
  std::string_view detail; ///< what the reader needs beside the name
};

constexpr std::array<Shape, 8> shapes{{{"Polyvertex", " NodesPerElement=\"1\""},
                                       {"Polyline", " NodesPerElement=\"2\""},
                                       {"Triangle", ""},
                                       {"Quadrilateral", ""},
                                       {"Tetrahedron", ""},
                                       {"Pyramid", ""},
                                       {"Wedge", ""},
                                       {"Hexahedron", ""}}};

std::string escaped(std::string_view text)
{
  std::string out;
  for (const char c : text) {
    switch (c) {
    case '&': out += "&amp;"; break;
    case '<': out += "&lt;"; break;
    case '>': out += "&gt;"; break;
    case '"': out += "&quot;"; break;
    default: out += c;
    }
  }
  return out;
}

std::string data_item(std::string_view file, std::string_view dataset, std::string_view extents, bool is_real)
{
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">"
                     "results/{}.h5:{}</DataItem>",
                     extents, is_real ? "Float" : "Int", is_real ? 8 : 4, file, escaped(dataset));
}

std::string topology(const std::string& group, const PaneData& pane)
{
  if (pane.n_elements == 0) // a cloud of nodes: each is shown as a point
    return fmt::format("<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">{}"
                       "</Topology>\n",
                       pane.n_nodes, data_item("mesh", group + "/topology", fmt::format("{} 1", pane.n_nodes), false));
  if (pane.blocks.size() == 1) {
    const auto& block = pane.blocks.front();
    const auto& shape = shapes.at(block.element);
    return fmt::format("<Topology TopologyType=\"{}\" NumberOfElements=\"{}\"{}>{}</Topology>\n", shape.name,
                       block.n_elements, shape.detail,
                       data_item("mesh", group + "/connectivity_0",
                                 fmt::format("{} {}", block.n_elements, block.nodes_per_element), false));
  }
  std::int64_t length = 0;
  for (const auto& block : pane.blocks) {
    const int extra = block.element <= MULLION_LINE2 ? 2 : 1; // points and lines say their number of nodes
    length += block.n_elements * (block.nodes_per_element + extra);
  }
  return fmt::format("<Topology TopologyType=\"Mixed\" NumberOfElements=\"{}\">{}</Topology>\n", pane.n_elements,
                     data_item("mesh", group + "/topology", fmt::format("{}", length), false));
}

/// 1 component: Scalar; 2 and 3: Vector (ParaView 5.11 pads two with a zero); more: Matrix.
std::string attribute(std::string_view file, const std::string& group, const FieldData& field)
{
  if (field.entities == 0 || field.components == 0) return "";
  const char* const type = field.components == 1 ? "Scalar" : field.components <= 3 ? "Vector" : "Matrix";
  const char* const center = field.location == MULLION_NODE      ? "Node"
                             : field.location == MULLION_ELEMENT ? "Cell"
                                                                 : "Grid";
  const auto extents = field.components == 1 ? fmt::format("{}", field.entities)
                                             : fmt::format("{} {}", field.entities, field.components);
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n", escaped(field.name),
                     type, center, data_item(file, group + "/" + field.name, extents, field.f64 != nullptr));
}

} // namespace

std::string pane_group(const WindowData& window, const PaneData& pane)
{
  return fmt::format("/{}/pane_{}", window.name, pane.id);
}

std::string output_name(std::int64_t step) { return fmt::format("{:09}", step); }

void XdmfIndex::set_mesh(const std::vector<WindowData>& windows)
{
  fixed_.clear();
  for (const auto& window : windows)
    for (const auto& pane : window.panes) {
      const auto group = pane_group(window, pane);
      auto& text = fixed_[group];
      text = topology(group, pane);
      for (const auto& field : pane.fields) text += attribute("mesh", group, field);
    }
}

void XdmfIndex::add(std::int64_t step, double time, const std::vector<WindowData>& windows)
{
  std::string layout(output_begin);
  const std::string file(1, step_mark);
  for (const auto& window : windows)
    for (const auto& pane : window.panes) {
      if (pane.n_nodes == 0) continue; // readers stumble over grids without nodes
      const auto group = pane_group(window, pane);
      layout += fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n{}", escaped(group.substr(1)), fixed_.at(group));
      layout += fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                            data_item(file, group + "/geometry", fmt::format("{} 3", pane.n_nodes), true));
      for (const auto& field : pane.fields) layout += attribute(file, group, field);
      layout += "</Grid>\n";
    }
  layout += output_end;
  outputs_.push_back({step, time, intern(std::move(layout))});
}

const std::string* XdmfIndex::intern(std::string layout)
{
  return &layouts_.try_emplace(std::move(layout), 0).first->first;
}

OutputList XdmfIndex::list() const
{
  OutputList list;
  std::map<const std::string*, std::int64_t> numbers;
  for (const auto& output : outputs_) {
    const auto [number, is_new] = numbers.try_emplace(output.layout, static_cast<std::int64_t>(list.texts.size()));
    if (is_new) list.texts.push_back(*output.layout);
    list.steps.push_back(output.step);
    list.times.push_back(output.time);
    list.layouts.push_back(number->second);
  }
  return list;
}

void XdmfIndex::restore(const OutputList& list)
{
  MULLION_REQUIRE(list.steps.size() == list.times.size() && list.steps.size() == list.layouts.size(), Errc::io,
                  "a list of outputs has {} steps, {} times and {} layouts", list.steps.size(), list.times.size(),
                  list.layouts.size());
  std::vector<Output> found;
  for (std::size_t i = 0; i < list.steps.size(); ++i) {
    const auto layout = list.layouts[i];
    MULLION_REQUIRE(0 <= layout && static_cast<std::size_t>(layout) < list.texts.size(), Errc::io,
                    "the output of step {} has layout {} of {}", list.steps[i], layout, list.texts.size());
    found.push_back({list.steps[i], list.times[i], intern(list.texts[static_cast<std::size_t>(layout)])});
  }
  outputs_ = std::move(found);
}

std::string XdmfIndex::text() const
{
  std::size_t size = head.size() + tail.size();
  for (const auto& output : outputs_) size += output.layout->size() + 256;
  std::string out;
  out.reserve(size);
  out += head;
  for (const auto& output : outputs_) {
    const auto name = output_name(output.step);
    for (const char c : *output.layout) {
      if (c == step_mark) out += name;
      else if (c == time_mark) fmt::format_to(std::back_inserter(out), "{}", output.time);
      else out += c;
    }
  }
  out += tail;
  return out;
}

} // namespace mullion::io
