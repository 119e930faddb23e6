// Look into a live run: what windows and fields there are, what is in them, what takes the time. The windows are mapped
// read-only into this process: the run notices nothing, whatever becomes of the one who looks.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mullion {

/// A field of the last committed level.
struct FieldLook {
  std::string name, unit;
  std::string location, role, nature; ///< "node", "state", "intensive"
  std::uint32_t pane = 0, components = 0;
  std::int64_t entities = 0;
  std::string source; ///< of a bound field: whose values these are, "mesh_motion/volume.velocity"
  double smallest = 0.0, largest = 0.0, mean = 0.0, norm = 0.0; ///< over all values; norm: root of the sum of squares
  std::vector<double> values;                                   ///< the first ones, entity by entity
};

struct WindowLook {
  std::string name;  ///< "structure/wet"
  std::string owner; ///< "structure", "driver"
  std::uint32_t generation = 0, dimension = 0, committed_levels = 0;
  std::uint64_t bytes = 0;
  std::int64_t nodes = 0, elements = 0; ///< of all panes
  std::int64_t step = 0;                ///< of the last committed level
  double time = 0.0;                    ///< [s] for which it holds
  std::vector<FieldLook> fields;        ///< in an overview without numbers
};

struct CallLook {
  std::string call;
  std::int64_t count = 0;
  double wall_s = 0.0, work_s = 0.0; ///< from request to answer; inside the module
};

struct ModuleLook {
  std::string instance, kind, plugin;
  bool is_inline = false;
  long pid = 0;                  ///< of its process; 0: inline
  std::uint32_t incarnation = 0; ///< processes that carried it so far
  std::vector<CallLook> calls;   ///< those that were made
};

struct RunLook {
  std::string name;
  long guard = 0, orchestrator = 0;
  std::int64_t step = 0, n_steps = 0;
  double time = 0.0;
  std::string at_work; ///< "structure: step", or "" between calls
  std::vector<ModuleLook> modules;
  std::vector<WindowLook> windows;
};

/// The whole run: modules, timings, windows and their fields, without numbers.
/// @throws Error Errc::config: no such run (with the live ones); Errc::process: it is not that far yet, or at its end
RunLook look_at_run(const std::string& run);

/// One window, or one of its fields, with numbers, all of one commit.
/// @param path      "structure/wet" or "structure.wet"; with ".displacement" behind it that field alone
/// @param n_values  of each field at most
/// @throws Error Errc::config: no such run, window or field, with the nearest; Errc::process
WindowLook look_at_window(const std::string& run, const std::string& path, std::size_t n_values);

std::string to_json(const RunLook& run);
std::string to_json(const WindowLook& window);

} // namespace mullion
