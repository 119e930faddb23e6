// One process's mappings of a run's windows, made when first asked for and renewed when a window gets a new
// generation. Every mapping is checked before anything in it is believed.
#pragma once

#include "shm/control.hpp"
#include "shm/memory_object.hpp"

#include <array>

namespace mullion::shm {

class WindowMap {
public:
  /// Read-only, but for what the orchestrator owns (companions, driver/state) in the orchestrator.
  WindowMap(const Control& control, bool is_orchestrator) : control_(control), is_orchestrator_(is_orchestrator) {}

  /// The checked window, mapped with the right that this process has. @throws Error Errc::memory
  const WindowView& view(std::uint32_t window);

  /// A module's windows become writable here: in the orchestrator an inline one's, in a host its own.
  void allow(std::uint32_t module) { writable_modules_ |= 1u << module; }
  /// Its windows are unmapped, and mapped read-only when next looked at.
  void forbid(std::uint32_t module);
  /// No mapping and no right is left.
  void forget_all()
  {
    writable_modules_ = 0;
    entries_ = {};
  }

  [[nodiscard]] const Control& control() const { return control_; }

  /// The data of a field at a level of the table that `epoch` names; bound fields lead to their source's data.
  /// @throws Error Errc::memory if the level does not exist
  struct Location {
    std::byte* data;
    const FieldRecord* field;
  };
  Location locate(std::uint32_t window, std::uint32_t field, int level, std::uint64_t epoch);

  /// The window whose mapping holds this address, or null. Async-signal-safe.
  [[nodiscard]] const char* window_at(const void* address) const;

private:
  struct Entry {
    std::uint32_t generation = 0;
    bool is_writable = false;
    Mapping mapping;
    WindowView view;
  };
  [[nodiscard]] bool may_write(const WindowRecord& record) const;

  const Control& control_;
  bool is_orchestrator_;
  std::uint32_t writable_modules_ = 0;
  std::array<Entry, max_windows> entries_;
};

} // namespace mullion::shm
