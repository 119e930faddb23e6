// The live coupling: modules (inline or in hosts), their windows, the companions and driver/state, and the calls
// between them. The driver's proxies are thin handles into this; the run loop is in simulation.cpp.
//
// Writes: the control object, companions, driver/state, and the windows of inline modules. When a host dies, the
// call at hand throws an Error that names it; when this process dies, the hosts go with it.
#pragma once

#include "io/checkpoint.hpp"
#include "module/module_runtime.hpp"
#include "plugin/catalogue.hpp"
#include "process/supervisor.hpp"
#include "run/checker.hpp"
#include "run/field_address.hpp"
#include "run/ledger.hpp"
#include "run/timings.hpp"
#include "shm/control.hpp"
#include "shm/window_map.hpp"

#include <mullion/app/case_file.hpp>
#include <mullion/coupling/driver.hpp>

#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace mullion::run {

struct SessionOptions {
  bool is_audited = false;   ///< poison what a step must write (--replay)
  bool has_deadlines = true; ///< false: --no-deadline
};

class Session {
public:
  Session(const Case& the_case, plugin::Catalogue& catalogue, shm::Control& control, process::Supervisor& supervisor,
          SessionOptions options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  // ---- the run loop's side (setup.cpp, session.cpp) ----
  /// Fresh start: spawn, define, wire, attach, start; all levels then hold the initial state.
  void start_fresh();
  /// Its first part alone: the windows of all modules, in their first state. No module is attached, no driver at work.
  void define_windows();
  /// After define_windows(): attach this module, without anything that it receives, so that its functions answer.
  void attach_alone(const std::string& instance);
  /// The same from a checkpoint: spawn, windows from the file, attach. (session_restore.cpp)
  /// @param changed  modules with other parameters than then: their windows must have the same shape all the same
  /// @throws Error Errc::config: the checkpoint's windows are not those of this case and its plug-ins
  void start_from(const io::Checkpoint& from, const std::set<std::string>& changed);
  /// A start-up failed: kill what there is of hosts and forget all windows, so that it can be done again.
  void forget_start();
  /// Begin a coupling step from the last commit: forget what was written, arm driver/state.
  void begin_attempt();
  void run_driver(const TimeStep& step);
  /// Has the interface moved further than the case allows? @throws Error Errc::numeric with the place
  void check_limits(const TimeStep& step);
  /// All that was written becomes committed.
  void commit(const TimeStep& step);
  /// Fresh processes for all modules in hosts, a new driver object; state comes from the windows.
  void renew();
  /// Await what is in flight, whatever comes of it: a failed step leaves calls behind.
  void quiesce();
  /// After a host died: quiesce, respawn the dead, attach them and a new driver object.
  /// @return instances of the respawned modules; none if no host is dead
  /// @throws Error Errc::process: one died again meanwhile; call it again, or give up
  std::vector<std::string> recover();
  /// The last death: which module, how, in which call; the same text if the same happens again.
  [[nodiscard]] const std::string& last_death() const { return last_death_; }
  /// Ask the hosts to quit; kills what does not.
  void shut_down();

  // ---- another carrier of a module, or another driver object, between two steps (swap.cpp) ----
  /// The candidate attaches to the windows as they are, read-only; then the carrier at work lets go of them and is
  /// parked, and the candidate is on trial until keep() or take_back().
  /// @throws Error Errc::plugin: it does not fit, or could not attach; nothing has changed
  void try_module(std::uint32_t module, ModuleCase candidate, const mullion_module& entries);
  /// The same for a candidate in a process, in two parts: it is started and attaches beside the run, which goes on with
  /// the carrier at work; when it is due, between two steps, it is exchanged and on trial. (swap_beside.cpp)
  /// @throws Error Errc::plugin: it does not fit, or could not attach; nothing has changed
  void begin_candidate(std::uint32_t module, ModuleCase candidate, const mullion_module& entries);
  [[nodiscard]] bool has_candidate() const { return candidate_.has_value(); }
  [[nodiscard]] bool is_candidate_due() const; ///< it has attached, or never will
  void exchange_candidate();
  void drop_candidate();
  /// May a module of this live run get these values of parameters that are not declared changeable? It may if what its
  /// define makes stays the same. (swap_definition.cpp)
  /// @param changes  for messages: "origin = 2"
  /// @throws Error Errc::plugin: its windows would have another size, mesh or first state; nothing has changed
  void require_same_definition(std::uint32_t module, const ModuleCase& candidate, const mullion_module& entries,
                               const std::string& changes);
  /// The same for the driver with other parameters. @throws Error Errc::plugin: they would change what is connected
  void try_driver(std::vector<ParameterValue> parameters);
  [[nodiscard]] bool has_trial() const { return trial_.has_value(); }
  /// Its first step was committed: the parked one goes. @pre case_ says what the candidate is
  void keep();
  /// Its first step failed: the parked one is at work again, and the step can be done once more.
  void take_back();

  // ---- the driver's side ----
  void begin(std::uint32_t module, shm::Operation operation, std::uint32_t function, const TimeStep& step, double stamp,
             const double* arguments = nullptr, std::uint32_t n_arguments = 0);
  void await(std::uint32_t module);
  [[nodiscard]] double result(std::uint32_t module) const { return modules_[module].result; }
  [[nodiscard]] std::uint32_t find_module(const std::string& instance) const;
  [[nodiscard]] std::uint32_t find_function(std::uint32_t module, const std::string& name, std::uint32_t n_arguments,
                                            std::uint32_t n_results) const;
  [[nodiscard]] FieldAddress find_field(const std::string& port, bool is_received, std::uint32_t pane);
  [[nodiscard]] FieldAddress find_state(const std::string& name);
  [[nodiscard]] Pane pane_of(const std::string& window, std::uint32_t pane);
  [[nodiscard]] ConstArray read(FieldAddress at, int level);
  [[nodiscard]] Array write(FieldAddress at);
  void stamp(FieldAddress at, double time, std::uint32_t kind);
  void exchange(FieldAddress at); ///< somebody else reads it: check it for finite values
  void warn(const std::string& text) const;

  // ---- onlookers within the orchestrator ----
  [[nodiscard]] shm::Control& control() { return control_; }
  [[nodiscard]] shm::WindowMap& windows() { return windows_; }
  [[nodiscard]] const Case& the_case() const { return case_; }
  [[nodiscard]] const std::vector<CallTiming>& timings(std::uint32_t module) const { return modules_[module].timings; }
  /// The same for another thread, once the run is under way.
  [[nodiscard]] std::vector<CallTiming> timings_so_far(std::uint32_t module) const;
  /// Text for a post-mortem: the last lines of every host that died.
  [[nodiscard]] std::string post_mortem() const;
  /// The case as it stands, for a checkpoint: what was swapped or set since the start counts.
  [[nodiscard]] const std::string& case_text() const { return case_.text; }
  /// What the driver declared: connections, state, net lag, …
  [[nodiscard]] const Wiring& wiring() const { return *wiring_; }
  [[nodiscard]] const std::optional<Ledger>& ledger() const { return ledger_; }
  /// @returns no_window if the run has no driver/state
  [[nodiscard]] std::uint32_t state_window() const { return state_window_; }
  /// A number that a module answers, if it offers such a function of so many numbers; else nothing.
  [[nodiscard]] std::optional<double> ask(const std::string& instance, const std::string& function,
                                          std::span<const double> arguments);
  /// The windows that this attempt wrote, in the order of their first writing: who differs first is the culprit.
  [[nodiscard]] const std::vector<std::uint32_t>& write_order() const { return write_order_; }

private:
  /// What carries a module: a swap exchanges it.
  struct Carrier {
    const ModuleCase* config = nullptr;
    const mullion_module* entries = nullptr;
    std::unique_ptr<module::ModuleRuntime> runtime;           ///< inline
    std::shared_ptr<process::Host> host;                      ///< in a process
    std::vector<std::vector<std::uint32_t>> function_windows; ///< per function
  };

  struct Module : Carrier {
    double clock_offset = 0.0;              ///< [s] of its clock against the run's
    std::vector<std::uint32_t> windows;     ///< its own
    std::uint32_t conflicts = 0;            ///< modules that read its windows, or whose windows it reads, in place
    std::vector<FieldAddress> large_fields; ///< exchanged, and left to us by its runtime to check
    bool in_flight = false;
    bool is_attached = false; ///< its host knows its windows
    shm::Operation operation = shm::Operation::none;
    std::uint32_t function = 0;
    TimeStep step;
    double stamp = 0.0, result = 0.0;
    Clock::time_point begun;
    std::chrono::nanoseconds paused{0}; ///< all pauses until then
    std::exception_ptr inline_error;
    std::vector<module::ModuleRuntime::Defined> defined; ///< inline, between define and adoption
    std::int64_t inline_work_ns = 0;
    std::vector<CallTiming> timings;  ///< step, then the functions in their order
    std::set<std::uint32_t> poisoned; ///< windows, in this attempt
  };

  /// A large field whose check for finite values is under way, in the order of writing.
  struct Check {
    std::uint32_t module;
    FieldAddress field;
    std::string call; ///< "module 'fluid' (…) failed in step, step 7, t = 0.1 s": the module may be called meanwhile
  };

  /// A candidate at work, and what takes over again if its first step fails.
  struct Trial {
    std::uint32_t module = shm::no_module; ///< no_module: the driver is on trial
    ModuleCase config;
    std::vector<ParameterValue> driver_parameters;
    std::optional<Wiring> wiring; ///< of the driver
    Carrier parked;
  };

  /// One that attaches beside the run. The carrier's config is the one here.
  struct Candidate {
    std::uint32_t module = 0;
    ModuleCase config;
    Carrier carrier;
    std::uint32_t number = 0; ///< of the request in which it attaches
    Clock::time_point begun;
    std::chrono::nanoseconds paused{0}; ///< all pauses until then
  };

  /// Another carrier in the place of the one at work, as long as this lives: for calls between two steps. What is
  /// there at the end is let go of.
  class StandIn {
  public:
    StandIn(Session& session, std::uint32_t module, const ModuleCase& config, const mullion_module& entries);
    ~StandIn();
    StandIn(const StandIn&) = delete;
    StandIn& operator=(const StandIn&) = delete;

  private:
    Session& session_;
    std::uint32_t module_;
    Carrier at_work_;
  };

  // swap.cpp
  void require_fit(std::uint32_t module, const ModuleCase& candidate, const mullion_module& entries);
  /// @param prepare  makes the candidate, which has the place of the carrier at work by then, ready to get the windows
  void put_on_trial(std::uint32_t module, ModuleCase config, Carrier candidate,
                    const std::function<void(const TimeStep& at)>& prepare);
  void show_host(std::uint32_t module); ///< in the control object
  void hand_over(std::uint32_t module, const TimeStep& at);
  void restore_parked();
  [[nodiscard]] TimeStep now() const; ///< for calls between two steps
  void attach_driver();
  void arrange_timings(Module& module);
  // swap_beside.cpp
  void attach_beside(std::uint32_t module);
  [[nodiscard]] bool is_candidate_late() const;
  // swap_definition.cpp
  struct Definition;
  [[nodiscard]] Definition define_apart(std::uint32_t module, const ModuleCase& config, const mullion_module& entries);

  // setup.cpp
  void describe_modules();
  void describe(std::uint32_t module); ///< its plug-in and parameters in the control object
  void spawn(std::uint32_t module);
  void call_all(shm::Operation operation, const TimeStep& step);
  void call(std::uint32_t module, shm::Operation operation, const TimeStep& step);
  void adopt_windows(std::uint32_t module);
  std::uint32_t register_window(const std::string& name, shm::Owner owner, std::uint32_t module, shm::Descriptor object,
                                std::uint64_t bytes, std::uint32_t n_slots);
  void make_window(const shm::WindowPlan& plan, std::uint32_t module);
  void make_companions();
  void make_driver_state();
  void find_ledger();
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> find_function_windows(const std::string& instance,
                                                                              const mullion_module& entries) const;
  Wiring make_driver();
  void attach_all(const TimeStep& at);
  void attach_again(const std::vector<std::uint32_t>& modules);
  void find_conflicts();

  // session_restore.cpp
  void restore_module_windows(const io::Checkpoint& from);
  void restore_own_windows(const io::Checkpoint& from);
  void restore_levels(std::uint32_t window, const io::CheckpointWindow& from);
  void check_definition(std::uint32_t module);

  // setup.cpp
  Wiring make_wiring() const;

  // session.cpp
  void mark_written(std::uint32_t window, const mullion_stamp& stamp);
  [[nodiscard]] const std::vector<std::uint32_t>& windows_written(const Module& module) const;
  void refuse_conflicts(std::uint32_t module) const;
  void await_host(Module& module);
  [[noreturn]] void fail(const Module& module, Errc code, const std::string& what) const;
  /// Its process ended, by itself or by us. @param how "was killed by signal 9 (SIGKILL)"
  [[noreturn]] void fail_by_end(const Module& module, const std::string& how);
  [[nodiscard]] std::string who(const Module& module) const;
  [[nodiscard]] std::string where(const Module& module) const;
  [[nodiscard]] static const char* call_name(const Module& module); ///< that it is in, or was in last

  // session_checks.cpp
  /// @throws Error what define left for others to read is not finite
  void check_first_state();
  void check_later(std::uint32_t module); ///< what its runtime left of its last call
  /// Wait for the first checks of this attempt. @throws Error the first value, in write order, that is not finite
  void settle(std::size_t n_checks);
  /// Have the driver do its part, await what it forgot, settle all checks; none is left when it failed, either.
  void run_and_settle(const std::function<void()>& drive);
  void settle_before_writing(std::uint32_t module);
  void forget_checks();

  const Case& case_;
  plugin::Catalogue& catalogue_;
  shm::Control& control_;
  process::Supervisor& supervisor_;
  SessionOptions options_;
  shm::WindowMap windows_;
  std::vector<Module> modules_;
  std::vector<shm::Descriptor> objects_; ///< of all windows: they live as long as this
  std::optional<Wiring> wiring_;
  const std::vector<ParameterValue>* driver_parameters_;
  std::unique_ptr<Driver> driver_;
  std::optional<Trial> trial_;
  std::optional<Candidate> candidate_; ///< not while one is on trial
  mutable std::mutex timings_mutex_;   ///< held where the list of a module's timings changes, or is read elsewhere
  std::uint32_t state_window_ = shm::no_window;
  std::optional<Ledger> ledger_;
  std::vector<std::uint32_t> write_order_;
  std::uint32_t n_in_flight_ = 0;
  std::string last_death_;
  std::vector<Check> checks_; ///< of this attempt
  std::size_t n_settled_ = 0;
  Checker checker_;         ///< after windows_, into which it looks
  bool is_running_ = false; ///< steps, rather than the start-up, whose deadline is longer
};

} // namespace mullion::run
