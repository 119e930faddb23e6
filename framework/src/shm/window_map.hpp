// One process's mappings of a run's windows, made when first asked for and renewed when a window gets a new
// generation. Every mapping is checked before anything in it is believed.
#pragma once

#include "shm/control.hpp"
#include "shm/memory_object.hpp"

#include <array>

namespace mullion::shm {

class WindowMap {
public:
  /// @param writable_module  the module whose windows this process may write (no_module: none)
  /// @param is_orchestrator  companions and driver/state are writable
  WindowMap(const Control& control, std::uint32_t writable_module, bool is_orchestrator)
      : control_(control), writable_module_(writable_module), is_orchestrator_(is_orchestrator)
  {
  }

  /// The checked window, mapped with the right that this process has. @throws Error Errc::memory
  const WindowView& view(std::uint32_t window);

  /// An inline module's windows become writable in the orchestrator.
  void allow(std::uint32_t module) { inline_modules_ |= 1u << module; }
  void forbid(std::uint32_t module);
  /// No mapping and no right is left.
  void forget_all()
  {
    inline_modules_ = 0;
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
  std::uint32_t writable_module_;
  bool is_orchestrator_;
  std::uint32_t inline_modules_ = 0;
  std::array<Entry, max_windows> entries_;
};

} // namespace mullion::shm
