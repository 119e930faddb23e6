// How a driver says which received field comes from where. Connections are declared before any window exists and
// checked against the plug-ins' declarations (unit, location, components, nature), so that `mullion check` finds
// a mismatch without running anything.
//
// A port is written instance.window.field ("fluid.wall.traction"); the same name on the receiving side means the
// field in the companion of that window.
#pragma once

#include <mullion/sdk/field.hpp>

#include <string>
#include <vector>

namespace mullion {

/// A pair of interface windows, as [coupling] interfaces lists them.
struct InterfacePair {
  std::string fluid, structure; ///< instance.window
};

struct Connection {
  std::string receiver;                     ///< instance.window.field, an input
  std::string source;                       ///< bound: instance.window.field; empty: stored
  TimePolicy policy = TimePolicy::constant; ///< how the receiver reads between the stamped levels
  int levels = 2;                           ///< stored: slots of the companion, the working one included
};

/// A field of driver/state, shaped like a port's field, or `size` numbers.
struct StateField {
  std::string name;
  std::string like; ///< instance.window.field (owned or received); empty: `size` numbers
  int size = 0;
};

/// A module's window that must keep more committed levels than one.
struct HistoryRequest {
  std::string window; ///< instance.window
  int committed_levels;
};

class Wiring {
public:
  Wiring(std::vector<InterfacePair> interfaces, std::vector<std::pair<std::string, std::string>> instances)
      : interfaces_(std::move(interfaces)), instances_(std::move(instances))
  {
  }

  /// The instance of a kind ("fluid"), for kinds that a case has once.
  /// @throws Error Errc::config if the case has none
  [[nodiscard]] std::string instance(const std::string& kind) const;
  [[nodiscard]] const std::vector<InterfacePair>& interfaces() const { return interfaces_; }

  /// The receiver reads the source in place: no copy. Legal where the two never run at the same time.
  void bind(const std::string& receiver, const std::string& source, TimePolicy policy = TimePolicy::constant)
  {
    connections.push_back({receiver, source, policy, 0});
  }
  /// The driver writes the received field itself (combined, corrected, relaxed) with InputField::put.
  void store(const std::string& receiver, TimePolicy policy = TimePolicy::constant, int committed_levels = 1)
  {
    connections.push_back({receiver, "", policy, committed_levels + 1});
  }
  /// A field of driver/state with the shape of another field.
  void state_like(const std::string& name, const std::string& port) { states.push_back({name, port, 0}); }
  void state_numbers(const std::string& name, int size) { states.push_back({name, "", size}); }
  void state_levels(int committed_levels) { committed_state_levels = committed_levels; }
  /// Keep more committed levels of a module's window.
  void history(const std::string& window, int committed_levels) { histories.push_back({window, committed_levels}); }
  /// The scheme cannot take steps of varying size.
  void require_constant_step() { needs_constant_step = true; }

  std::vector<Connection> connections;
  std::vector<StateField> states;
  std::vector<HistoryRequest> histories;
  int committed_state_levels = 1;
  bool needs_constant_step = false;

private:
  std::vector<InterfacePair> interfaces_;
  std::vector<std::pair<std::string, std::string>> instances_; ///< (kind, instance)
};

} // namespace mullion
