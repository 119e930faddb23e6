#include "shm/window_layout.hpp"

#include <mullion/sdk/error.hpp>
#include <mullion/sdk/mesh.hpp>

#include <algorithm>
#include <cstring>

namespace mullion::shm {
namespace {

static_assert(sizeof(WindowHeader) % 8 == 0 && sizeof(PaneRecord) % 8 == 0 && sizeof(BlockRecord) % 8 == 0 &&
              sizeof(FieldRecord) % 8 == 0);

constexpr std::uint64_t too_large = 1ull << 62;

std::uint64_t round_up(std::uint64_t value, std::uint64_t to) { return (value + to - 1) / to * to; }

void copy_name(char* to, std::size_t capacity, const std::string& name, const char* what)
{
  MULLION_REQUIRE(name.size() < capacity, Errc::shape, "the {} '{}' is longer than {} characters", what, name,
                  capacity - 1);
  std::memset(to, 0, capacity);
  std::memcpy(to, name.data(), name.size());
}

/// FNV-1a, 64 bit: catches damage, not malice.
std::uint64_t checksum(std::span<const std::byte> bytes, std::uint64_t hash)
{
  for (const auto byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3ull;
  return hash;
}

std::uint64_t schema_checksum(const std::byte* object)
{
  WindowHeader header;
  std::memcpy(&header, object, sizeof header);
  header.schema_checksum = 0;
  const auto first = checksum(std::as_bytes(std::span(&header, 1)), 0xcbf29ce484222325ull);
  return checksum({object + sizeof header, header.fixed_offset - sizeof header}, first);
}

/// Walks through the object in the order of the layout and hands out aligned offsets.
class Cursor {
public:
  explicit Cursor(std::uint64_t start) : at_(start) {}
  std::uint64_t take(std::uint64_t count, std::uint64_t each)
  {
    at_ = round_up(at_, alignment);
    const auto offset = at_;
    MULLION_REQUIRE(each == 0 || count <= too_large / each, Errc::shape, "an array of {} entries is too large", count);
    at_ += count * each;
    MULLION_REQUIRE(at_ < too_large, Errc::shape, "a window of {} bytes is too large", at_);
    return offset;
  }
  [[nodiscard]] std::uint64_t at() const { return at_; }

private:
  std::uint64_t at_;
};

/// Header and records with all offsets filled in.
struct Schema {
  WindowHeader header{};
  std::vector<PaneRecord> panes;
  std::vector<BlockRecord> blocks;
  std::vector<FieldRecord> fields;
};

Schema make_schema(const WindowPlan& plan)
{
  Schema schema;
  auto& header = schema.header;
  copy_name(header.name, sizeof header.name, plan.name, "window name");
  for (const auto& pane : plan.panes) {
    MULLION_REQUIRE(pane.n_nodes >= 0 && pane.n_elements >= 0, Errc::shape, "window {}: a pane has {} nodes", plan.name,
                    pane.n_nodes);
    schema.panes.push_back(
        {pane.id, pane.n_nodes, pane.n_elements, 0, static_cast<std::uint32_t>(schema.blocks.size()), pane.n_blocks});
    for (std::uint32_t b = 0; b < pane.n_blocks; ++b)
      schema.blocks.push_back({pane.blocks[b].element, pane.blocks[b].nodes_per_element, pane.blocks[b].n_elements, 0});
  }
  header.magic = window_magic;
  header.version = layout_version;
  header.generation = plan.generation;
  header.n_panes = static_cast<std::uint32_t>(schema.panes.size());
  header.n_blocks = static_cast<std::uint32_t>(schema.blocks.size());
  header.n_fields = static_cast<std::uint32_t>(plan.fields.size());
  header.n_slots = plan.n_slots;
  header.dimension = plan.dimension;

  header.panes_offset = sizeof(WindowHeader);
  header.blocks_offset = header.panes_offset + schema.panes.size() * sizeof(PaneRecord);
  header.fields_offset = header.blocks_offset + schema.blocks.size() * sizeof(BlockRecord);
  header.fixed_offset = round_up(header.fields_offset + plan.fields.size() * sizeof(FieldRecord), alignment);

  Cursor fixed(header.fixed_offset);
  for (std::size_t p = 0; p < plan.panes.size(); ++p) {
    const auto& pane = plan.panes[p];
    if (pane.coordinates != nullptr)
      schema.panes[p].coordinates_offset =
          fixed.take(static_cast<std::uint64_t>(pane.n_nodes) * plan.dimension, sizeof(double));
    for (std::uint32_t b = 0; b < pane.n_blocks; ++b) {
      auto& block = schema.blocks[schema.panes[p].first_block + b];
      block.connectivity_offset =
          fixed.take(static_cast<std::uint64_t>(block.n_elements) * block.nodes_per_element, sizeof(std::int32_t));
    }
  }
  Cursor level(0);
  for (const auto& plan_field : plan.fields) {
    FieldRecord record{};
    copy_name(record.name, sizeof record.name, plan_field.name, "field name");
    copy_name(record.unit, sizeof record.unit, plan_field.unit, "unit");
    record.pane = plan_field.pane;
    record.location = plan_field.location;
    record.components = plan_field.components;
    record.role = plan_field.role;
    record.nature = plan_field.nature;
    record.carry = plan_field.carry;
    record.scalar = plan_field.scalar;
    record.storage = static_cast<std::uint32_t>(plan_field.storage);
    record.entities = plan_field.entities;
    record.source_window = plan_field.source_window;
    record.source_field = plan_field.source_field;
    record.policy = plan_field.policy;
    const auto count = static_cast<std::uint64_t>(record.entities) * record.components;
    if (plan_field.storage == Storage::fixed) record.offset = fixed.take(count, scalar_bytes(record.scalar));
    if (plan_field.storage == Storage::level) record.offset = level.take(count, scalar_bytes(record.scalar));
    schema.fields.push_back(record);
  }
  header.fixed_bytes = fixed.at() - header.fixed_offset;
  header.slots_offset = round_up(fixed.at(), page);
  header.slot_bytes = round_up(level.at(), page);
  MULLION_REQUIRE(header.slot_bytes <= too_large / std::max(1u, plan.n_slots), Errc::shape, "window {} is too large",
                  plan.name);
  header.total_bytes = std::max(header.slots_offset + plan.n_slots * header.slot_bytes, page);
  return schema;
}

} // namespace

std::uint64_t window_bytes(const WindowPlan& plan) { return make_schema(plan).header.total_bytes; }

void write_window(const WindowPlan& plan, std::byte* object, std::uint64_t bytes)
{
  auto schema = make_schema(plan);
  MULLION_ASSERT(bytes >= schema.header.total_bytes, "window {} needs {} bytes", plan.name, schema.header.total_bytes);
  const auto write = [&](std::uint64_t offset, const void* from, std::uint64_t n) {
    if (n > 0) std::memcpy(object + offset, from, n);
  };
  write(schema.header.panes_offset, schema.panes.data(), schema.panes.size() * sizeof(PaneRecord));
  write(schema.header.blocks_offset, schema.blocks.data(), schema.blocks.size() * sizeof(BlockRecord));
  write(schema.header.fields_offset, schema.fields.data(), schema.fields.size() * sizeof(FieldRecord));
  for (std::size_t p = 0; p < plan.panes.size(); ++p) {
    const auto& pane = plan.panes[p];
    const auto& record = schema.panes[p];
    if (pane.coordinates != nullptr)
      write(record.coordinates_offset, pane.coordinates,
            static_cast<std::uint64_t>(pane.n_nodes) * plan.dimension * sizeof(double));
    for (std::uint32_t b = 0; b < pane.n_blocks; ++b) {
      const auto& block = schema.blocks[record.first_block + b];
      write(block.connectivity_offset, pane.blocks[b].connectivity,
            static_cast<std::uint64_t>(block.n_elements) * block.nodes_per_element * sizeof(std::int32_t));
    }
  }
  write(0, &schema.header, sizeof schema.header);
  schema.header.schema_checksum = schema_checksum(object);
  write(0, &schema.header, sizeof schema.header);
}

WindowView::WindowView(std::byte* object, std::uint64_t bytes, std::string_view expected_name)
{
  const auto require = [&](bool holds, const char* what, std::uint64_t found, std::uint64_t expected) {
    MULLION_REQUIRE(holds, Errc::memory,
                    "window {}: its memory object is damaged or foreign: {} is {}, expected {}; nothing was read "
                    "from it",
                    expected_name, what, found, expected);
  };
  require(bytes >= sizeof(WindowHeader), "the size", bytes, sizeof(WindowHeader));
  WindowHeader h;
  std::memcpy(&h, object, sizeof h);
  require(h.magic == window_magic, "the magic number", h.magic, window_magic);
  require(h.version == layout_version, "the layout version", h.version, layout_version);
  require(h.total_bytes <= bytes, "the recorded size", h.total_bytes, bytes);
  require(h.panes_offset == sizeof(WindowHeader), "the panes' offset", h.panes_offset, sizeof(WindowHeader));
  const auto blocks_offset = h.panes_offset + std::uint64_t{h.n_panes} * sizeof(PaneRecord);
  require(h.blocks_offset == blocks_offset, "the blocks' offset", h.blocks_offset, blocks_offset);
  const auto fields_offset = h.blocks_offset + std::uint64_t{h.n_blocks} * sizeof(BlockRecord);
  require(h.fields_offset == fields_offset, "the fields' offset", h.fields_offset, fields_offset);
  const auto fixed_offset = round_up(h.fields_offset + std::uint64_t{h.n_fields} * sizeof(FieldRecord), alignment);
  require(h.fixed_offset == fixed_offset && fixed_offset <= bytes, "the fixed part's offset", h.fixed_offset,
          fixed_offset);
  schema_ = std::make_shared<const std::vector<std::byte>>(object, object + fixed_offset);
  h = header(); // from here on only the copy counts
  require(h.fixed_offset == fixed_offset, "the fixed part's offset", h.fixed_offset, fixed_offset);
  const auto hash = schema_checksum(schema_->data());
  require(h.schema_checksum == hash, "the schema's checksum", h.schema_checksum, hash);
  // From here on the records are what their owner wrote; the checks below catch an owner that wrote nonsense.
  const auto inside = [](std::uint64_t offset, std::uint64_t size, std::uint64_t from, std::uint64_t to) {
    return offset >= from && offset <= to && size <= to - offset;
  };
  const auto fixed_end = h.fixed_offset + h.fixed_bytes;
  require(h.fixed_bytes <= bytes && fixed_end <= bytes, "the fixed part's end", fixed_end, bytes);
  require(h.dimension <= 3, "the number of coordinates a node", h.dimension, 3);
  require(h.n_slots >= 1 && h.n_slots <= MULLION_MAX_LEVELS + 1, "the number of slots", h.n_slots,
          MULLION_MAX_LEVELS + 1);
  require(h.slot_bytes <= bytes / h.n_slots && inside(h.slots_offset, h.n_slots * h.slot_bytes, fixed_end, bytes) &&
              h.slots_offset % page == 0 && h.slot_bytes % page == 0,
          "the slots' offset", h.slots_offset, fixed_end);
  require(std::memchr(h.name, 0, sizeof h.name) != nullptr && expected_name == h.name, "the name's length",
          ::strnlen(h.name, sizeof h.name), expected_name.size());
  object_ = object;
  for (const auto& p : panes()) {
    require(p.n_nodes >= 0 && p.n_nodes <= INT32_MAX, "a pane's number of nodes", static_cast<std::uint64_t>(p.n_nodes),
            INT32_MAX);
    require(p.n_elements >= 0 && p.n_elements <= INT32_MAX, "a pane's number of elements",
            static_cast<std::uint64_t>(p.n_elements), INT32_MAX);
    const auto n = static_cast<std::uint64_t>(p.n_nodes) * h.dimension * sizeof(double);
    require(p.coordinates_offset == 0 ||
                (inside(p.coordinates_offset, n, h.fixed_offset, fixed_end) && p.coordinates_offset % alignment == 0),
            "a pane's coordinates' offset", p.coordinates_offset, h.fixed_offset);
    require(std::uint64_t{p.first_block} + p.n_blocks <= h.n_blocks, "a pane's last block",
            std::uint64_t{p.first_block} + p.n_blocks, h.n_blocks);
    std::int64_t n_elements = 0;
    for (const auto& b : blocks().subspan(p.first_block, p.n_blocks)) {
      require(b.nodes_per_element == nodes_per_element(b.element) && b.nodes_per_element > 0, "nodes per element",
              b.nodes_per_element, nodes_per_element(b.element));
      require(b.n_elements >= 0 && b.n_elements <= INT32_MAX, "a block's number of elements",
              static_cast<std::uint64_t>(b.n_elements), INT32_MAX);
      const auto size = static_cast<std::uint64_t>(b.n_elements) * b.nodes_per_element * sizeof(std::int32_t);
      require(inside(b.connectivity_offset, size, h.fixed_offset, fixed_end) && b.connectivity_offset % alignment == 0,
              "a block's connectivity offset", b.connectivity_offset, h.fixed_offset);
      const auto* nodes = reinterpret_cast<const std::int32_t*>(object + b.connectivity_offset);
      for (std::uint64_t i = 0; i < size / sizeof(std::int32_t); ++i)
        require(nodes[i] >= 0 && nodes[i] < p.n_nodes, "a node number in the connectivity",
                static_cast<std::uint64_t>(nodes[i]), static_cast<std::uint64_t>(p.n_nodes));
      n_elements += b.n_elements;
    }
    require(p.n_blocks == 0 || n_elements == p.n_elements, "a pane's number of elements",
            static_cast<std::uint64_t>(n_elements), static_cast<std::uint64_t>(p.n_elements));
  }
  for (const auto& f : fields()) {
    require(std::memchr(f.name, 0, sizeof f.name) != nullptr && std::memchr(f.unit, 0, sizeof f.unit) != nullptr,
            "a field name's length", sizeof f.name, sizeof f.name - 1);
    require(f.pane < h.n_panes, "a field's pane", f.pane, h.n_panes);
    require(f.scalar <= MULLION_I32 && f.storage <= 2 && f.role <= 2 && f.location <= 2, "a field's kind", f.storage,
            2);
    require(f.components > 0 && f.components <= 4096 && f.entities >= 0 && f.entities <= INT64_C(1) << 40,
            "a field's size", static_cast<std::uint64_t>(f.entities), 1);
    if (static_cast<Storage>(f.storage) == Storage::level)
      require(inside(f.offset, field_bytes(f), 0, h.slot_bytes) && f.offset % alignment == 0, "a field's offset",
              f.offset, h.slot_bytes);
    if (static_cast<Storage>(f.storage) == Storage::fixed)
      require(inside(f.offset, field_bytes(f), h.fixed_offset, fixed_end) && f.offset % alignment == 0,
              "a field's offset", f.offset, h.fixed_offset);
  }
}

std::span<const PaneRecord> WindowView::panes() const
{
  return {reinterpret_cast<const PaneRecord*>(schema_->data() + header().panes_offset), header().n_panes};
}

std::span<const BlockRecord> WindowView::blocks() const
{
  return {reinterpret_cast<const BlockRecord*>(schema_->data() + header().blocks_offset), header().n_blocks};
}

std::span<const FieldRecord> WindowView::fields() const
{
  return {reinterpret_cast<const FieldRecord*>(schema_->data() + header().fields_offset), header().n_fields};
}

int WindowView::find_field(std::uint32_t pane, std::string_view name) const
{
  const auto all = fields();
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i].pane == pane && name == all[i].name) return static_cast<int>(i);
  return -1;
}

mullion_pane WindowView::pane(std::uint32_t index, std::vector<mullion_block>& out) const
{
  const auto& record = panes()[index];
  MULLION_REQUIRE(record.coordinates_offset != 0 || record.n_nodes == 0, Errc::shape,
                  "window {}: its pane {} holds no mesh; a companion's mesh is that of the window it belongs to",
                  header().name, index);
  out.clear();
  for (const auto& b : blocks().subspan(record.first_block, record.n_blocks))
    out.push_back({b.element, b.nodes_per_element, b.n_elements,
                   reinterpret_cast<const std::int32_t*>(object_ + b.connectivity_offset)});
  return {record.id,         record.n_nodes,
          record.n_elements, reinterpret_cast<const double*>(object_ + record.coordinates_offset),
          out.data(),        record.n_blocks,
          header().dimension};
}

} // namespace mullion::shm
