// The bytes of a window object: a versioned, flat layout of fixed-width numbers and offsets, the same in every
// process and readable from C, Fortran or Python (docs/formats/window_layout.md). One object holds, in this order:
//
//   WindowHeader | PaneRecord… | BlockRecord… | FieldRecord…      the schema, under a checksum
//   fixed part:  reference coordinates, connectivity, fixed fields (64-byte aligned each)
//   slots:       n_slots blocks of slot_bytes, page-aligned; every level field at the same offset in each
//
// Who writes: the window's owner alone. Which slot is which level stands in the control object, not here.
// What happens when a process dies: nothing; a schema is written before anyone else learns of the object.
#pragma once

#include <mullion/sdk/abi.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace mullion::shm {

inline constexpr std::uint64_t window_magic = 0x31574e4f494c4c4d; // "MLLIONW1"
inline constexpr std::uint32_t layout_version = 2;
inline constexpr std::uint64_t page = 4096;
inline constexpr std::uint64_t alignment = 64;
inline constexpr std::uint32_t no_window = 0xffffffff;

enum class Storage : std::uint32_t {
  level = 0, ///< one copy per slot, offset counts from the slot's start
  fixed = 1, ///< one copy, offset counts from the object's start
  bound = 2  ///< no copy: an alias of a field of another window
};

struct WindowHeader {
  std::uint64_t magic;
  std::uint32_t version, generation;
  std::uint32_t n_panes, n_blocks, n_fields, n_slots;
  std::uint32_t dimension, reserved;
  std::uint64_t total_bytes;
  std::uint64_t panes_offset, blocks_offset, fields_offset;
  std::uint64_t fixed_offset, fixed_bytes;
  std::uint64_t slots_offset, slot_bytes;
  std::uint64_t schema_checksum; ///< FNV-1a over all records and this header, this member counted as 0
  char name[MULLION_MAX_NAME];   ///< "structure/wet"
};

struct PaneRecord {
  std::int64_t id, n_nodes, n_elements;
  std::uint64_t coordinates_offset; ///< dimension x n_nodes doubles; 0 in companions
  std::uint32_t first_block, n_blocks;
};

struct BlockRecord {
  std::uint32_t element, nodes_per_element;
  std::int64_t n_elements;
  std::uint64_t connectivity_offset; ///< nodes_per_element x n_elements int32
};

struct FieldRecord {
  char name[MULLION_MAX_NAME];
  char unit[32];
  std::uint32_t pane, location, components, role;
  std::uint32_t nature, carry, scalar, storage;
  std::int64_t entities;
  std::uint64_t offset;
  std::uint32_t source_window, source_field; ///< bound fields: ids in the control object and in that window
  std::uint32_t policy, reserved;            ///< received fields: how they vary within a step
};

/// What a window shall hold; the input of write_window().
struct FieldPlan {
  std::string name, unit;
  std::uint32_t pane = 0, location = 0, components = 1, role = 0;
  std::uint32_t nature = 0, carry = 0, scalar = 0;
  Storage storage = Storage::level;
  std::int64_t entities = 0;
  std::uint32_t source_window = no_window, source_field = 0, policy = 0;
};
struct WindowPlan {
  std::string name;
  std::uint32_t dimension = 0, generation = 1, n_slots = 2;
  std::vector<mullion_pane> panes; ///< coordinates and blocks may be null (companions, driver/state)
  std::vector<FieldPlan> fields;
};

/// The size of the object that write_window() needs. @throws Error Errc::shape if it is beyond 2^62 bytes
std::uint64_t window_bytes(const WindowPlan& plan);

/// Write schema, coordinates and connectivity; slots and fixed fields stay as they are (zero in a new object).
void write_window(const WindowPlan& plan, std::byte* object, std::uint64_t bytes);

/// A checked window object. Every record and offset was found to lie inside of it. The schema is a private copy: a
/// module that garbles its own header later cannot mislead anybody.
class WindowView {
public:
  WindowView() = default;
  /// @throws Error Errc::memory naming what is wrong: magic, version, size, checksum, an offset
  WindowView(std::byte* object, std::uint64_t bytes, std::string_view expected_name);

  [[nodiscard]] bool is_valid() const { return object_ != nullptr; }
  [[nodiscard]] const WindowHeader& header() const { return *reinterpret_cast<const WindowHeader*>(schema_->data()); }
  [[nodiscard]] std::span<const PaneRecord> panes() const;
  [[nodiscard]] std::span<const BlockRecord> blocks() const;
  [[nodiscard]] std::span<const FieldRecord> fields() const;

  /// Number of the field, or -1.
  [[nodiscard]] int find_field(std::uint32_t pane, std::string_view name) const;
  [[nodiscard]] std::byte* slot(std::uint32_t index) const
  {
    return object_ + header().slots_offset + index * header().slot_bytes;
  }
  /// Where the values of a fixed or level field start. @pre the field is not bound
  [[nodiscard]] std::byte* data(const FieldRecord& field, std::uint32_t slot_index) const
  {
    return static_cast<Storage>(field.storage) == Storage::fixed ? object_ + field.offset
                                                                 : slot(slot_index) + field.offset;
  }
  [[nodiscard]] std::byte* object() const { return object_; }
  /// The mesh of a pane; `blocks` is filled and must outlive the result.
  /// @throws Error Errc::shape if the pane has nodes and no mesh (a companion's)
  [[nodiscard]] mullion_pane pane(std::uint32_t index, std::vector<mullion_block>& blocks) const;

private:
  std::byte* object_ = nullptr;
  std::shared_ptr<const std::vector<std::byte>> schema_; ///< header and records
};

constexpr std::uint64_t scalar_bytes(std::uint32_t scalar) { return scalar == MULLION_I32 ? 4 : 8; }
inline std::uint64_t field_bytes(const FieldRecord& field)
{
  return static_cast<std::uint64_t>(field.entities) * field.components * scalar_bytes(field.scalar);
}

} // namespace mullion::shm
