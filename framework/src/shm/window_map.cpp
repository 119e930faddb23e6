#include "shm/window_map.hpp"

#include <mullion/sdk/error.hpp>

namespace mullion::shm {

bool WindowMap::may_write(const WindowRecord& record) const
{
  if (record.owner == Owner::orchestrator) return is_orchestrator_;
  return (writable_modules_ >> record.module & 1u) != 0;
}

void WindowMap::forbid(std::uint32_t module)
{
  writable_modules_ &= ~(1u << module);
  for (std::uint32_t w = 0; w < control_.n_windows; ++w)
    if (control_.windows[w].owner == Owner::module && control_.windows[w].module == module) entries_[w] = {};
}

const WindowView& WindowMap::view(std::uint32_t window)
{
  MULLION_ASSERT(window < control_.n_windows, "window {} of {}", window, control_.n_windows);
  const auto& record = control_.windows[window];
  auto& entry = entries_[window];
  if (entry.view.is_valid() && entry.generation == record.generation && entry.is_writable == may_write(record))
    return entry.view;
  entry.is_writable = may_write(record);
  entry.mapping =
      map_object(control_.orchestrator_pid, record.fd, entry.is_writable ? Access::read_write : Access::read_only);
  entry.view = WindowView(entry.mapping.data, entry.mapping.bytes, record.name);
  entry.generation = record.generation;
  return entry.view;
}

const char* WindowMap::window_at(const void* address) const
{
  const auto* at = static_cast<const std::byte*>(address);
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    const auto& mapping = entries_[w].mapping;
    if (mapping.data != nullptr && mapping.data <= at && at < mapping.data + mapping.bytes)
      return control_.windows[w].name;
  }
  return nullptr;
}

WindowMap::Location WindowMap::locate(std::uint32_t window, std::uint32_t field, int level, std::uint64_t epoch)
{
  const auto* map = &view(window);
  const auto* record = &map->fields()[field];
  if (static_cast<Storage>(record->storage) == Storage::bound) {
    window = record->source_window;
    field = record->source_field;
    map = &view(window);
    MULLION_REQUIRE(field < map->header().n_fields, Errc::memory, "a bound field leads to field {} of {}, which has {}",
                    field, control_.windows[window].name, map->header().n_fields);
    record = &map->fields()[field];
  }
  const auto& levels = control_.table(epoch).windows[window];
  MULLION_REQUIRE(
      level >= 0 && static_cast<std::uint32_t>(level) < levels.n_slots, Errc::shape,
      "window {} keeps {} committed level{}; level -{} was asked for (the driver of a run says how many each "
      "window keeps, and no module can have more)",
      control_.windows[window].name, levels.n_slots - 1, levels.n_slots == 2 ? "" : "s", level);
  return {map->data(*record, slot_of(levels, level)), record};
}

} // namespace mullion::shm
