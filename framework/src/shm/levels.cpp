#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace mullion::shm {
namespace {

template <class Body> void for_each_level_field(const WindowView& window, Body&& body)
{
  for (const auto& field : window.fields())
    if (static_cast<Storage>(field.storage) == Storage::level) body(field);
}

bool is_carried(const FieldRecord& field) { return field.role == MULLION_STATE && field.carry == MULLION_COPY; }

} // namespace

void initialise_levels(Control& control, std::uint32_t window, std::uint32_t n_slots, double t0, double dt)
{
  for (auto& table : control.levels) {
    auto& entry = table.windows[window];
    entry.working_slot = 0;
    entry.n_slots = n_slots;
    for (int k = 1; k <= MULLION_MAX_LEVELS; ++k)
      entry.committed[k - 1] = {t0 - (k - 1) * dt, 1 - k, 0, MULLION_INSTANT};
  }
  control.working[window] = {};
}

void commit(Control& control)
{
  const auto epoch = control.epoch.load(std::memory_order_relaxed);
  const auto& now = control.table(epoch);
  auto& next = control.levels[(epoch + 1) & 1];
  for (std::uint32_t w = 0; w < control.n_windows; ++w) {
    auto& entry = next.windows[w];
    entry = now.windows[w];
    auto& working = control.working[w];
    if (working.is_written == 0) continue;
    entry.working_slot = (entry.working_slot + 1) % entry.n_slots;
    const auto kept = std::min<std::uint32_t>(entry.n_slots, MULLION_MAX_LEVELS);
    for (std::uint32_t k = kept - 1; k > 0; --k) entry.committed[k] = entry.committed[k - 1];
    entry.committed[0] = working.stamp;
  }
  control.epoch.store(epoch + 1, std::memory_order_release);
  roll_back(control);
}

void roll_back(Control& control)
{
  for (std::uint32_t w = 0; w < control.n_windows; ++w) control.working[w].is_written = 0;
}

void arm(const WindowView& window, const LevelEntry& levels)
{
  const auto to = slot_of(levels, 0), from = slot_of(levels, 1);
  for_each_level_field(window, [&](const FieldRecord& field) {
    if (is_carried(field)) std::memcpy(window.data(field, to), window.data(field, from), field_bytes(field));
  });
}

void poison_working(const WindowView& window, const LevelEntry& levels)
{
  for_each_level_field(window, [&](const FieldRecord& field) {
    if (is_carried(field) || field.scalar != MULLION_F64) return;
    auto* bits = reinterpret_cast<std::uint64_t*>(window.data(field, slot_of(levels, 0)));
    std::fill_n(bits, field_bytes(field) / sizeof *bits, poison_bits);
  });
}

std::optional<std::string> find_poison(const WindowView& window, const LevelEntry& levels)
{
  std::optional<std::string> found;
  for_each_level_field(window, [&](const FieldRecord& field) {
    if (found || is_carried(field) || field.scalar != MULLION_F64) return;
    const auto* bits = reinterpret_cast<const std::uint64_t*>(window.data(field, slot_of(levels, 0)));
    const auto n = field_bytes(field) / sizeof *bits;
    for (std::uint64_t i = 0; i < n; ++i)
      if (bits[i] == poison_bits) {
        found = fmt::format("{}[{}, {}]", field.name, i % field.components, i / field.components);
        return;
      }
  });
  return found;
}

void seal(const WindowView& window, const LevelEntry& levels)
{
  const auto working = slot_of(levels, 0);
  for (std::uint32_t s = 0; s < levels.n_slots; ++s)
    if (s != working) std::memcpy(window.slot(s), window.slot(working), window.header().slot_bytes);
}

namespace {

/// first_not_finite() over fields of the caches, or over those beyond them: these prefetch the chunk that comes next,
/// which the processor cannot guess because it lies before this one (measured: 29 GB/s instead of 15).
template <bool is_beyond_caches> std::int64_t first_not_finite_of(const double* values, std::int64_t n)
{
  constexpr std::int64_t chunk = 8192, n_lanes = 8; // lanes of one cache line together
  std::int64_t first = -1;
  for (std::int64_t start = (n - 1) / chunk * chunk; start >= 0; start -= chunk) {
    const auto end = std::min(n, start + chunk);
    [[maybe_unused]] const double* next = values + std::max(start - chunk, std::int64_t{0});
    double lanes[n_lanes] = {};
    std::int64_t i = start;
    for (; i + n_lanes <= end; i += n_lanes) {
      if constexpr (is_beyond_caches) __builtin_prefetch(next + (i - start));
      for (std::int64_t lane = 0; lane < n_lanes; ++lane) lanes[lane] += values[i + lane];
    }
    double sum = 0.0;
    for (; i < end; ++i) sum += values[i];
    for (const double lane : lanes) sum += lane;
    if (std::isfinite(sum)) continue;
    for (i = end - 1; i >= start; --i)
      if (!std::isfinite(values[i])) first = i;
  }
  return first;
}

} // namespace

std::int64_t first_not_finite(const double* values, std::int64_t n, bool is_beyond_caches)
{
  // This runs over every exchanged field in every step: one addition a value, in eight independent lanes, which the
  // compiler turns into vector additions without reordering any. Infinities and NaN survive in a sum; a sum that
  // overflows by itself only costs a closer look at its chunk.
  //
  // The chunks are taken from the last to the first: what was written last is what the caches still hold, and the
  // reader, who comes next and starts at the front, finds the front there.
  return is_beyond_caches ? first_not_finite_of<true>(values, n) : first_not_finite_of<false>(values, n);
}

std::string describe_not_finite(const char* window, const FieldRecord& field, const double* values, std::int64_t at)
{
  return fmt::format("{}.{}[{}, {}] = {} (component, entity): not a finite number", window, field.name,
                     at % field.components, at / field.components, values[at]);
}

} // namespace mullion::shm
