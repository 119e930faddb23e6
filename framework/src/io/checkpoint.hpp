// A checkpoint: all that a run needs in order to go on, as plain data, and the bytes of its file
// (docs/formats/checkpoint.md). It knows neither windows nor sessions: who makes one points it at committed levels,
// who reads one gets spans into what it holds. Values are stored as the bytes that stand in memory, so that what is
// read back is what was there, to the last bit.
#pragma once

#include "io/atomic_file.hpp"
#include "io/hdf5_image.hpp"
#include "io/xdmf_index.hpp"

#include <mullion/sdk/abi.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace mullion::io {

/// One window: its object up to the slots (schema, mesh, fixed fields), and its committed levels, newest first.
struct CheckpointWindow {
  std::string name;     ///< "structure/wet", "structure/wet.in", "driver/state"
  std::string instance; ///< of the module that owns it; "": the orchestrator does
  std::uint32_t n_slots = 0, working_slot = 0;
  std::array<mullion_stamp, MULLION_MAX_LEVELS> stamps{}; ///< [k - 1]: of level -k
  std::span<const std::byte> head;
  std::vector<std::span<const std::byte>> levels; ///< n_slots - 1 of them, a slot each
};

/// Where the run stands, and from where its times are counted (run/step_clock.hpp).
struct CheckpointClock {
  std::int64_t step = 0;                    ///< steps committed so far
  double time = 0.0, dt = 0.0;              ///< [s] dt: of the case
  std::int64_t grid = 0, origin = 0;        ///< whole coupling steps done; the one that times count from
  double grid_time = 0.0, next_time = 0.0;  ///< [s] of `grid` and of the whole step behind it
  double origin_time = 0.0;                 ///< [s]
  std::int64_t n_halvings = 0, n_parts = 0; ///< the step at hand is halved so often; parts of it that are done
  std::int64_t n_good = 0, patience = 0;    ///< good steps since the last change of size, and how many it takes
};

/// What ran: to tell who comes back with another build of a plug-in.
struct CheckpointPlugin {
  std::string instance, kind, name, version, build; ///< the driver's instance is "driver"
};

struct Checkpoint {
  std::string run_name, case_text;
  std::string version, build; ///< of Mullion
  CheckpointClock clock;
  std::vector<CheckpointPlugin> plugins;
  OutputList outputs; ///< written so far
  std::vector<CheckpointWindow> windows;
  std::vector<Bytes> storage; ///< what the windows of a checkpoint that was read point into
};

/// The file's content, without its trailer.
/// @throws Error Errc::io with HDF5's own text
[[nodiscard]] Image to_image(const Checkpoint& checkpoint);

/// @throws Error Errc::io: unreadable, cut short, altered, or no checkpoint of this version of Mullion
[[nodiscard]] Checkpoint read_checkpoint(const std::filesystem::path& file);

} // namespace mullion::io
