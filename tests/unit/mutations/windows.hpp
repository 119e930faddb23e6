// Windows to damage, and the walk through one that was accepted: whatever a view hands out lies in its object.
#pragma once

#include "shm/window_layout.hpp"

#include <mullion/sdk/error.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace mullion::testing {

/// A plan with the arrays it points to.
struct PlannedWindow {
  std::vector<std::vector<double>> coordinates;
  std::vector<std::vector<std::int32_t>> connectivity;
  std::vector<std::vector<mullion_block>> blocks;
  shm::WindowPlan plan;

  PlannedWindow() = default;
  PlannedWindow(const PlannedWindow&) = delete;
  PlannedWindow(PlannedWindow&&) = default; // what a vector holds stays where it is

  void add_block(std::vector<mullion_block>& to, std::uint32_t element, std::uint32_t nodes,
                 std::vector<std::int32_t> list)
  {
    connectivity.push_back(std::move(list));
    to.push_back(
        {element, nodes, static_cast<std::int64_t>(connectivity.back().size() / nodes), connectivity.back().data()});
  }
  void add_pane(std::int64_t id, std::int64_t n_nodes, std::vector<mullion_block> list)
  {
    auto& x = coordinates.emplace_back();
    for (std::int64_t i = 0; i < n_nodes * plan.dimension; ++i) x.push_back(0.125 * static_cast<double>(i * i % 17));
    std::int64_t n_elements = 0;
    for (const auto& block : list) n_elements += block.n_elements;
    const auto n_blocks = static_cast<std::uint32_t>(list.size());
    blocks.push_back(std::move(list));
    plan.panes.push_back({id, n_nodes, n_elements, x.data(), blocks.back().data(), n_blocks, plan.dimension});
  }
  void add_field(const char* name, const char* unit, std::uint32_t pane, std::uint32_t location,
                 std::uint32_t components, shm::Storage storage = shm::Storage::level,
                 std::uint32_t scalar = MULLION_F64)
  {
    auto& field = plan.fields.emplace_back();
    field.name = name;
    field.unit = unit;
    field.pane = pane;
    field.location = location;
    field.components = components;
    field.storage = storage;
    field.scalar = scalar;
    field.role = storage == shm::Storage::fixed ? MULLION_FIXED : MULLION_STATE;
    const auto& of = plan.panes[pane];
    field.entities = location == MULLION_NODE ? of.n_nodes : location == MULLION_ELEMENT ? of.n_elements : 1;
    if (storage == shm::Storage::bound) field.source_window = 3;
  }
  [[nodiscard]] std::vector<std::byte> write() const
  {
    std::vector<std::byte> object(shm::window_bytes(plan));
    shm::write_window(plan, object.data(), object.size());
    return object;
  }
};

/// A volume of solids and one of plane elements, a wall of two panes, its companion without a mesh, and a window
/// of numbers alone.
inline std::vector<PlannedWindow> planned_windows()
{
  using shm::Storage;
  std::vector<PlannedWindow> windows;

  auto& solid = windows.emplace_back();
  solid.plan.name = "structure/solid";
  solid.plan.dimension = 3;
  solid.plan.n_slots = 3;
  std::vector<mullion_block> list;
  solid.add_block(list, MULLION_HEXAHEDRON8, 8, {0, 1, 2, 3, 4, 5, 6, 7});
  solid.add_block(list, MULLION_PYRAMID5, 5, {4, 5, 6, 7, 8});
  solid.add_block(list, MULLION_PRISM6, 6, {1, 9, 5, 2, 10, 6});
  solid.add_block(list, MULLION_TETRAHEDRON4, 4, {9, 11, 10, 5, 5, 6, 7, 8});
  solid.add_pane(1, 12, list);
  solid.add_field("displacement", "m", 0, MULLION_NODE, 3);
  solid.add_field("stress", "Pa", 0, MULLION_ELEMENT, 6);
  solid.add_field("part", "1", 0, MULLION_ELEMENT, 1, Storage::fixed, MULLION_I32);

  auto& volume = windows.emplace_back();
  volume.plan.name = "fluid/volume";
  volume.plan.dimension = 2;
  list.clear();
  volume.add_block(list, MULLION_QUADRILATERAL4, 4, {0, 1, 2, 3});
  volume.add_block(list, MULLION_TRIANGLE3, 3, {1, 4, 2});
  volume.add_pane(7, 5, list);
  list.clear();
  volume.add_block(list, MULLION_POINT1, 1, {0, 1});
  volume.add_pane(8, 2, list);
  volume.add_field("velocity", "m/s", 0, MULLION_NODE, 2);
  volume.add_field("pressure", "Pa", 0, MULLION_ELEMENT, 1);
  volume.add_field("numbers", "1", 1, MULLION_NODE, 1, Storage::fixed, MULLION_I32);
  volume.add_field("energy", "J", 1, MULLION_PANE, 1);

  auto& wall = windows.emplace_back();
  wall.plan.name = "fluid/wall";
  wall.plan.dimension = 2;
  wall.plan.n_slots = MULLION_MAX_LEVELS + 1;
  for (const std::int32_t n : {40, 3}) {
    std::vector<std::int32_t> lines;
    for (std::int32_t i = 0; i + 1 < n; ++i) lines.insert(lines.end(), {i, i + 1});
    list.clear();
    wall.add_block(list, MULLION_LINE2, 2, lines);
    wall.add_pane(n, n, list);
  }
  wall.add_field("traction", "Pa", 0, MULLION_NODE, 2);
  wall.add_field("traction", "Pa", 1, MULLION_ELEMENT, 2);
  wall.add_field("normal", "1", 1, MULLION_ELEMENT, 2, Storage::fixed);

  auto& companion = windows.emplace_back();
  companion.plan.name = "fluid/wall.in";
  companion.plan.dimension = 2;
  companion.plan.panes = {{40, 40, 39, nullptr, nullptr, 0, 2}, {3, 3, 2, nullptr, nullptr, 0, 2}};
  companion.add_field("velocity", "m/s", 0, MULLION_NODE, 2);
  companion.add_field("velocity", "m/s", 1, MULLION_NODE, 2, Storage::bound);

  auto& state = windows.emplace_back();
  state.plan.name = "driver/state";
  state.plan.panes = {{0, 0, 0, nullptr, nullptr, 0, 1}};
  state.add_field("work", "J", 0, MULLION_PANE, 1);
  return windows;
}

/// FNV-1a over header and records, written anew from docs/formats/window_layout.md: what stands in the header then
/// reaches the checks behind the checksum. Left alone if the schema does not end within the object.
inline void seal(std::vector<std::byte>& object)
{
  shm::WindowHeader header;
  if (object.size() < sizeof header) return;
  std::memcpy(&header, object.data(), sizeof header);
  if (header.fixed_offset < sizeof header || header.fixed_offset > object.size()) return;
  header.schema_checksum = 0;
  std::memcpy(object.data(), &header, sizeof header);
  std::uint64_t hash = 0xcbf29ce484222325u;
  for (std::size_t i = 0; i < header.fixed_offset; ++i)
    hash = (hash ^ static_cast<std::uint64_t>(object[i])) * 0x100000001b3u;
  header.schema_checksum = hash;
  std::memcpy(object.data(), &header, sizeof header);
}

/// Read all that the view hands out. The bounds are checked, too, so that it does not take a sanitizer to see a
/// reach beyond the object. @returns a sum over all that was read, so that reading it is no dead code
inline std::uint64_t walk(const shm::WindowView& view, const std::vector<std::byte>& object)
{
  std::uint64_t sum = std::strlen(view.header().name);
  const auto read = [&](const void* from, std::uint64_t size, std::uint64_t multiple) {
    const auto at = static_cast<std::uint64_t>(static_cast<const std::byte*>(from) - object.data());
    REQUIRE(at <= object.size());
    REQUIRE(size <= object.size() - at);
    REQUIRE(at % multiple == 0);
    for (std::uint64_t i = 0; i < size; ++i) sum += static_cast<std::uint64_t>(object[at + i]);
  };
  const auto& header = view.header();
  REQUIRE(header.dimension <= 3);
  std::vector<mullion_block> blocks;
  for (std::uint32_t p = 0; p < header.n_panes; ++p) {
    const auto& record = view.panes()[p];
    REQUIRE(record.n_nodes >= 0);
    REQUIRE(record.n_elements >= 0);
    if (record.coordinates_offset == 0 && record.n_nodes > 0) {
      CHECK_THROWS_AS((void)view.pane(p, blocks), Error); // a companion has no mesh
      continue;
    }
    const auto pane = view.pane(p, blocks);
    read(pane.coordinates, static_cast<std::uint64_t>(pane.n_nodes) * pane.dimension * sizeof(double), 8);
    for (std::uint32_t b = 0; b < pane.n_blocks; ++b) {
      const auto n = static_cast<std::uint64_t>(blocks[b].n_elements) * blocks[b].nodes_per_element;
      read(blocks[b].connectivity, n * sizeof(std::int32_t), 4);
      for (std::uint64_t i = 0; i < n; ++i)
        REQUIRE(std::uint64_t(blocks[b].connectivity[i]) < std::uint64_t(pane.n_nodes));
    }
  }
  for (const auto& field : view.fields()) {
    REQUIRE(field.pane < header.n_panes);
    sum += std::strlen(field.name) + std::strlen(field.unit);
    CHECK(view.find_field(field.pane, field.name) >= 0);
    if (static_cast<shm::Storage>(field.storage) == shm::Storage::bound) continue;
    for (std::uint32_t s = 0; s < header.n_slots; ++s) read(view.data(field, s), shm::field_bytes(field), 8);
  }
  for (std::uint32_t s = 0; s < header.n_slots; ++s) read(view.slot(s), header.slot_bytes, 64);
  return sum;
}

/// Open an object and walk through it if it is accepted. @returns is it refused, with its name and a reason?
inline bool is_refused(std::vector<std::byte>& object, const std::string& name)
{
  try {
    const shm::WindowView view(object.data(), object.size(), name);
    CHECK(walk(view, object) > 0);
    return false;
  } catch (const Error& error) {
    CHECK(error.code() == Errc::memory);
    const std::string text = error.what();
    CHECK_MESSAGE(text.starts_with("window " + name + ": "), text);
    CHECK_MESSAGE(text.find("expected") != std::string::npos, text);
    return true;
  }
}

} // namespace mullion::testing
