// How a driver says which received field comes from where. Connections are declared before any window exists and
// checked against the plug-ins' declarations (unit, location, components, nature), so that `mullion check` finds
// a mismatch without running anything.
//
// A port is written instance.window.field ("fluid.wall.traction"); the same name on the receiving side means the
// field in the companion of that window.
#pragma once

#include <mullion/sdk/field.hpp>

#include <optional>
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
  bool is_offer = false;                    ///< of no effect if the receiver has no such input
};

/// A field of driver/state, shaped like a port's field (or several of that shape side by side), or `size` numbers.
struct StateField {
  std::string name;
  std::string like;         ///< instance.window.field (owned or received); empty: `size` numbers
  int size = 0;             ///< like a field: how many copies of its shape
  bool is_reported = false; ///< a column driver.<name> of history.csv
};

/// A square matrix over the entries of some fields, in driver/state: the approximate Jacobian of an interface map.
struct StateSquare {
  std::string name;
  std::vector<std::string> like; ///< the ports whose entries are its rows and columns
  int largest = 0;               ///< with more rows than this it is not made: one number stands in its place
};

/// A module whose clock is shifted against the run's: its level 0 lies at t + steps * dt.
struct ClockOffset {
  std::string instance;
  double steps;
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
  [[nodiscard]] bool has(const std::string& kind) const;
  /// At least one pair: a scheme that couples nothing does not ask.
  /// @throws Error Errc::config if the case lists none
  [[nodiscard]] const std::vector<InterfacePair>& interfaces() const;

  /// The receiver reads the source in place: no copy. Legal where the two never run at the same time.
  void bind(const std::string& receiver, const std::string& source, TimePolicy policy = TimePolicy::constant)
  {
    connections.push_back({receiver, source, policy, 0});
  }
  /// The same for a field that some modules want and others do without: connected where the receiver declares it.
  void offer(const std::string& receiver, const std::string& source, TimePolicy policy = TimePolicy::constant)
  {
    connections.push_back({receiver, source, policy, 0, true});
  }
  /// The driver writes the received field itself (combined, corrected, relaxed) with InputField::put.
  void store(const std::string& receiver, TimePolicy policy = TimePolicy::constant, int committed_levels = 1)
  {
    connections.push_back({receiver, "", policy, committed_levels + 1});
  }
  /// A field of driver/state with the shape of another field.
  void state_like(const std::string& name, const std::string& port, int copies = 1)
  {
    states.push_back({name, port, copies});
  }
  void state_numbers(const std::string& name, int size) { states.push_back({name, "", size}); }
  void state_square(const std::string& name, std::vector<std::string> ports, int largest)
  {
    squares.push_back({name, std::move(ports), largest});
  }
  /// One number of driver/state that history.csv shows as driver.<name>, say the iterations of a step.
  void report_number(const std::string& name) { states.push_back({name, "", 1, true}); }
  void state_levels(int committed_levels) { committed_state_levels = committed_levels; }
  /// Keep more committed levels of a module's window.
  void history(const std::string& window, int committed_levels) { histories.push_back({window, committed_levels}); }
  /// The scheme cannot take steps of varying size.
  void require_constant_step() { needs_constant_step = true; }
  /// The module starts `steps` coupling steps away from the run's start (half-step schemes: -0.5).
  void offset_clock(const std::string& instance, double steps) { clock_offsets.push_back({instance, steps}); }
  /// The net time by which the load lags the motion, in coupling steps; what it does to a mode is printed beside what
  /// was measured. Leave it out where it is no constant of the scheme.
  void state_net_lag(double steps) { net_lag = steps; }
  /// What a user should know when this scheme's run diverges.
  void explain_divergence(std::string text) { divergence_hint = std::move(text); }

  std::vector<Connection> connections;
  std::vector<StateField> states;
  std::vector<StateSquare> squares;
  std::vector<HistoryRequest> histories;
  std::vector<ClockOffset> clock_offsets;
  std::optional<double> net_lag;
  std::string divergence_hint;
  int committed_state_levels = 1;
  bool needs_constant_step = false;

private:
  std::vector<InterfacePair> interfaces_;
  std::vector<std::pair<std::string, std::string>> instances_; ///< (kind, instance)
};

} // namespace mullion
