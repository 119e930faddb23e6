// A module at work in this process, be it a host or the orchestrator (inline): loads the plug-in, serves the C
// boundary (windows, views, received fields), and surrounds each step with what the rules ask for: arming,
// poisoning, the checks for unwritten and non-finite values (but for large fields: those the session checks).
//
// Writes: the module's own windows. When this process dies, the windows live on in the orchestrator.
#pragma once

#include "plugin/library.hpp"
#include "shm/control.hpp"
#include "shm/window_map.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace mullion::module {

using LogSink = std::function<void(std::uint32_t level, const std::string& text)>;

class ModuleRuntime {
public:
  ModuleRuntime(shm::WindowMap& windows, std::uint32_t module, LogSink log);
  ~ModuleRuntime();
  ModuleRuntime(const ModuleRuntime&) = delete;
  ModuleRuntime& operator=(const ModuleRuntime&) = delete;

  struct Defined {
    std::string name;
    shm::Descriptor object;
    shm::Mapping mapping;
    shm::WindowView view;
  };

  // Each of these throws mullion::Error with the module's own text.
  void create();
  /// The windows that the module made, all levels equal. The caller keeps the objects.
  std::vector<Defined> define(const mullion_step& initial);
  void attach();
  /// Did the last attach look at data of a level? What it derived from them holds for that commit only.
  [[nodiscard]] bool has_attached_to_levels() const { return has_attached_to_levels_; }
  void start(const mullion_step& initial);
  void seal();
  /// A step or a function, as the request says.
  void run(const shm::Request& request, double* results);

private:
  enum class Phase { idle, defining, attaching, starting, stepping };
  struct Handle {
    std::uint32_t window, field; ///< defining: number in defined_; else ids of the control object
  };
  struct PhaseGuard;

  [[nodiscard]] const shm::ModuleRecord& record() const { return windows_.control().modules[module_]; }
  void require(std::int32_t status);
  void invoke(std::int32_t (*entry)(void*, const mullion_step*), const mullion_step& step);
  [[nodiscard]] std::uint32_t own_window(const std::string& name) const;
  void list_windows();
  [[nodiscard]] const std::vector<std::uint32_t>& windows_written_by(const shm::Request& request) const;
  void check_written(const std::vector<std::uint32_t>& windows);
  void check_finite(const std::vector<std::uint32_t>& windows);

  // What the services do; each may throw.
  void make_window(const char* window, const mullion_pane* panes, std::uint32_t n_panes);
  const shm::WindowView& peer(const char* kind, const char* window, std::uint32_t pane);
  void own_pane(const char* window, std::uint32_t pane, mullion_pane* out);
  void find_field(const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle);
  void find_input(const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle);
  void view(std::uint32_t handle, std::int32_t level, mullion_array* out);
  void received(std::uint32_t handle, mullion_received* out);
  static const mullion_services services;
  template <class Body> static std::int32_t serve(void* context, Body&& body);

  shm::WindowMap& windows_;
  std::uint32_t module_;
  LogSink log_;
  std::optional<plugin::Library> library_;
  const mullion_module* entries_ = nullptr;
  void* instance_ = nullptr;
  Phase phase_ = Phase::idle;
  std::uint64_t epoch_ = 0;
  bool has_attached_to_levels_ = false;
  std::string error_;
  std::vector<Defined> defined_;
  std::vector<std::uint32_t> own_windows_;                   ///< ids, known from attach on
  std::vector<std::vector<std::uint32_t>> function_windows_; ///< what each function writes
  std::vector<Handle> handles_;
  std::vector<mullion_block> blocks_; ///< what the last pane service pointed into
};

} // namespace mullion::module
