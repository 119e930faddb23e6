// What is written at one output time, described by pointers into the windows: plain structs, so that the files'
// writers know nothing of shared memory. Nothing here owns values; a snapshot is read during the call that takes
// it and never kept. Arrays are (components x entities), one entity a column.
#pragma once

#include <mullion/sdk/abi.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace mullion::io {

/// One field of a pane: exactly one of f64 and i32 is set (either may be null where there are no entities).
struct FieldData {
  std::string name;
  std::string unit;
  std::optional<std::string> meaning;
  std::uint32_t location = MULLION_NODE; ///< MULLION_NODE, MULLION_ELEMENT or MULLION_PANE
  std::int64_t components = 1;
  std::int64_t entities = 0; ///< nodes, elements, or 1 for the pane
  const double* f64 = nullptr;
  const std::int32_t* i32 = nullptr;
};

struct PaneData {
  std::int64_t id = 0;
  std::uint32_t dimension = 0; ///< 1, 2 or 3
  std::int64_t n_nodes = 0;
  std::int64_t n_elements = 0;
  const double* reference_coordinates = nullptr; ///< (dimension x n_nodes) [m]
  std::vector<mullion_block> blocks;             ///< elements count through the blocks in their order
  std::vector<FieldData> fields;
};

struct WindowData {
  std::string name; ///< "<instance>/<window>", e.g. "fluid/volume"
  std::vector<PaneData> panes;
};

} // namespace mullion::io
