// What is done to the levels of windows: commit, arm, poison, seal. Functions over the control object and mapped
// windows; the orchestrator calls commit, whoever owns a window the rest.
#pragma once

#include "shm/control.hpp"
#include "shm/window_layout.hpp"

#include <optional>
#include <string>

namespace mullion::shm {

/// Every window starts with its working level in slot 0 and its committed levels stamped t0 - k dt
/// (minus its clock's offset, where a scheme has one), all equal once the windows are sealed.
void initialise_levels(Control& control, std::uint32_t window, std::uint32_t n_slots, double t0, double dt);

/// All windows whose working level was written become committed at once; the others keep their levels.
/// Fills the spare table, then flips the epoch with one release store.
void commit(Control& control);

/// Forget what was written since the last commit.
void roll_back(Control& control);

/// Copy the carried state of a window from level -1 into the working level.
void arm(const WindowView& window, const LevelEntry& levels);

/// The value that `--replay` puts where a step must write: a quiet NaN with a payload of our own.
inline constexpr std::uint64_t poison_bits = 0x7ff8'6d75'6c6c'696full; // payload "mullio"

/// Fill everything that arm() does not copy with poison.
void poison_working(const WindowView& window, const LevelEntry& levels);

/// The first output or overwritten state that still holds poison: "field[component, entity]", or nothing.
std::optional<std::string> find_poison(const WindowView& window, const LevelEntry& levels);

/// Copy the working level into every other slot: the initial state on all levels.
void seal(const WindowView& window, const LevelEntry& levels);

/// Index of the first value that is not finite, or -1. One pass, vectorised.
/// @param is_beyond_caches  prefetch: faster where the values come from memory, slower where a cache holds them
std::int64_t first_not_finite(const double* values, std::int64_t n, bool is_beyond_caches = false);

/// "structure/wet.velocity[1, 7] = nan (component, entity): not a finite number".
std::string describe_not_finite(const char* window, const FieldRecord& field, const double* values, std::int64_t at);

/// Fields from this size on are checked beside the run (run/checker.hpp), smaller ones at once after the call: there
/// the values still lie in the caches, and a look at them costs less than handing them over.
inline constexpr std::uint64_t large_field_bytes = 4 << 20;
inline bool is_checked_later(const FieldRecord& field)
{
  return field.scalar == MULLION_F64 && field_bytes(field) >= large_field_bytes;
}

} // namespace mullion::shm
