// How a session comes to life: modules described in the control object, hosts spawned, windows defined, everything
// attached, the first exchange made; and how it comes to life again after hosts died.
#include "config/check_wiring.hpp"
#include "config/parameter_table.hpp"
#include "log/console.hpp"
#include "run/session.hpp"
#include "shm/levels.hpp"

#include <mullion/coupling/driver_plugin.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cstring>

namespace mullion::run {

using shm::Operation;

namespace {

std::pair<std::string, std::string> split_window(const std::string& path) // "fluid.wall"
{
  const auto dot = path.find('.');
  return {path.substr(0, dot), path.substr(dot + 1)};
}

} // namespace

Session::Session(const Case& the_case, plugin::Catalogue& catalogue, shm::Control& control,
                 process::Supervisor& supervisor, SessionOptions options)
    : case_(the_case), catalogue_(catalogue), control_(control), supervisor_(supervisor), options_(options),
      windows_(control, true), modules_(the_case.modules.size()), driver_parameters_(&the_case.driver_parameters)
{
}

Session::~Session()
{
  if (trial_ && trial_->parked.host != nullptr) supervisor_.kill(*trial_->parked.host);
  if (candidate_) drop_candidate();
  driver_.reset();
  for (auto& module : modules_)
    if (module.host != nullptr) supervisor_.kill(*module.host);
}

void Session::define_windows()
{
  const TimeStep initial{0, case_.start_time, case_.start_time, case_.dt, 0};
  describe_modules();
  for (std::uint32_t m = 0; m < modules_.size(); ++m) spawn(m);
  call_all(Operation::create, initial);
  for (std::uint32_t m = 0; m < modules_.size(); ++m) { // in order: mesh motion and transfer look at the solvers
    call(m, Operation::define, initial);
    adopt_windows(m);
  }
}

void Session::attach_alone(const std::string& instance)
{
  const auto m = find_module(instance);
  call(m, Operation::attach, {0, case_.start_time, case_.start_time, case_.dt, 0});
  modules_[m].is_attached = true;
}

void Session::start_fresh()
{
  const TimeStep initial{0, case_.start_time, case_.start_time, case_.dt, 0};
  define_windows();
  make_companions();
  make_driver_state();
  find_conflicts();
  (void)make_driver();
  attach_all(initial);
  check_first_state();

  shm::roll_back(control_);
  if (state_window_ != shm::no_window) control_.working[state_window_].is_written = 1;
  run_and_settle([&] { driver_->start(initial); });
  call_all(Operation::seal, initial);
  const auto& table = control_.table(control_.epoch.load());
  for (std::uint32_t w = 0; w < control_.n_windows; ++w)
    if (control_.windows[w].owner == shm::Owner::orchestrator) shm::seal(windows_.view(w), table.windows[w]);
  shm::roll_back(control_);
  is_running_ = true;
}

void Session::forget_start()
{
  driver_.reset();
  trial_.reset();
  driver_parameters_ = &case_.driver_parameters;
  forget_checks();
  for (auto& module : modules_)
    if (module.host != nullptr) supervisor_.kill(*module.host);
  modules_ = std::vector<Module>(case_.modules.size());
  n_in_flight_ = 0;
  windows_.forget_all();
  objects_.clear();
  wiring_.reset();
  state_window_ = shm::no_window;
  ledger_.reset();
  write_order_.clear();
  shm::forget_windows_and_modules(control_);
}

void Session::renew()
{
  driver_.reset();
  std::vector<std::uint32_t> in_hosts;
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    if (modules_[m].host == nullptr) continue;
    supervisor_.kill(*modules_[m].host);
    in_hosts.push_back(m);
  }
  attach_again(in_hosts);
}

void Session::quiesce()
{
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    try {
      await(m);
    } catch (const Error& error) {
      log::debug("run", "while waiting for calls of a failed step: {}", error.what());
    }
  }
}

std::vector<std::string> Session::recover()
{
  quiesce();
  std::vector<std::uint32_t> dead;
  std::vector<std::string> names;
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    auto& module = modules_[m];
    if (module.host == nullptr) continue;
    if (!module.is_attached) supervisor_.kill(*module.host); // another one's death kept it from attaching
    if (!module.host->is_dead) continue;
    dead.push_back(m);
    names.push_back(module.config->instance);
  }
  if (!dead.empty()) attach_again(dead);
  return names;
}

void Session::attach_again(const std::vector<std::uint32_t>& modules)
{
  const auto at = now();
  is_running_ = false; // the start-up deadline holds
  shm::roll_back(control_);
  for (const auto m : modules) spawn(m);
  for (const auto operation : {Operation::create, Operation::attach}) {
    for (const auto m : modules) begin(m, operation, 0, at, at.end);
    for (const auto m : modules) await(m);
  }
  for (const auto m : modules) modules_[m].is_attached = true;
  (void)make_driver();
  Coupling coupling(this);
  driver_->attach(coupling);
  is_running_ = true;
}

// ---- modules -----------------------------------------------------------------------------------------------------

void Session::describe_modules()
{
  MULLION_REQUIRE(modules_.size() <= shm::max_modules, Errc::config, "a case has at most {} modules, this one has {}",
                  shm::max_modules, modules_.size());
  wiring_ = make_wiring();
  const auto& driver_library = catalogue_.open(case_.scheme);
  const auto values = config::to_values(case_.driver_parameters);
  const std::unique_ptr<Driver> driver(driver_library.driver().create(values.data()));
  driver->define(*wiring_);
  config::drop_declined_offers(*wiring_, case_, catalogue_);

  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    auto& module = modules_[m];
    module.config = &case_.modules[m];
    module.entries = &catalogue_.open(module.config->plugin).module();
    auto& record = control_.modules[m];
    const auto copy = [](auto& to, const std::string& text, const char* what) {
      shm::copy_text(to, sizeof to, text, what);
    };
    copy(record.name, module.config->instance, "instance name");
    copy(record.kind, module.config->kind, "kind");
    record.is_inline = module.config->is_process ? 0 : 1;
    for (const auto& offset : wiring_->clock_offsets)
      if (offset.instance == module.config->instance) module.clock_offset = offset.steps * case_.dt;
    for (const auto& pair : case_.interfaces)
      for (const auto& path : {pair.fluid, pair.structure})
        if (const auto [instance, window] = split_window(path); instance == module.config->instance)
          copy(record.interface_window, window, "window name");
    for (const auto& history : wiring_->histories)
      if (const auto [instance, window] = split_window(history.window); instance == module.config->instance) {
        auto& slot = record.histories[record.n_histories++];
        copy(slot.window, window, "window name");
        slot.n_slots = static_cast<std::uint32_t>(history.committed_levels) + 1;
      }
    describe(m);
    module.timings.push_back({"step"});
    for (std::uint32_t f = 0; f < module.entries->n_functions; ++f)
      module.timings.push_back({module.entries->functions[f].name});
    module.timings.push_back({attach_call});
    control_.n_modules = m + 1;
  }
}

void Session::describe(std::uint32_t m)
{
  const auto& config = *modules_[m].config;
  auto& record = control_.modules[m];
  shm::copy_text(record.plugin, sizeof record.plugin, config.plugin, "plug-in name");
  shm::copy_text(record.path, sizeof record.path, config.path, "plug-in path");
  MULLION_REQUIRE(config.parameters.size() <= shm::max_parameters, Errc::config,
                  "plug-in {} has more than {} parameters", config.plugin, shm::max_parameters);
  record.n_parameters = 0;
  std::size_t used = 1; // offset 0 is the empty text
  for (const auto& value : config::to_values(config.parameters)) {
    auto& parameter = record.parameters[record.n_parameters++];
    parameter = {value.real, value.integer, 0, 0};
    const std::size_t length = std::strlen(value.text);
    if (length == 0) continue;
    MULLION_REQUIRE(used + length + 1 <= sizeof record.text, Errc::config,
                    "the texts among the parameters of '{}' are longer than {} characters together", record.name,
                    sizeof record.text);
    std::memcpy(record.text + used, value.text, length + 1);
    parameter.text_offset = static_cast<std::uint32_t>(used);
    used += length + 1;
  }
}

void Session::spawn(std::uint32_t m)
{
  auto& module = modules_[m];
  module.is_attached = false;
  if (module.config->is_process) {
    module.host = supervisor_.spawn(m);
    return;
  }
  windows_.allow(m);
  module.runtime = std::make_unique<module::ModuleRuntime>(
      windows_, m, [name = module.config->instance](std::uint32_t level, const std::string& text) {
        log::write(log::level_of(level), name, text);
      });
}

void Session::call(std::uint32_t module, Operation operation, const TimeStep& step)
{
  begin(module, operation, 0, step, step.end);
  await(module);
}

void Session::attach_all(const TimeStep& at)
{
  call_all(Operation::attach, at);
  for (auto& module : modules_) module.is_attached = true;
  Coupling coupling(this);
  driver_->attach(coupling);
}

void Session::call_all(Operation operation, const TimeStep& step)
{
  // Hosts at the same time; none of these calls reads what another writes.
  for (std::uint32_t m = 0; m < modules_.size(); ++m)
    if (modules_[m].host != nullptr) begin(m, operation, 0, step, step.end);
  for (std::uint32_t m = 0; m < modules_.size(); ++m)
    if (modules_[m].host != nullptr) await(m);
    else call(m, operation, step);
}

Wiring Session::make_wiring() const
{
  std::vector<InterfacePair> interfaces;
  for (const auto& pair : case_.interfaces) interfaces.push_back({pair.fluid, pair.structure});
  std::vector<std::pair<std::string, std::string>> instances;
  for (const auto& module : case_.modules) instances.emplace_back(module.kind, module.instance);
  return {std::move(interfaces), std::move(instances)};
}

Wiring Session::make_driver()
{
  const auto values = config::to_values(*driver_parameters_);
  driver_.reset(catalogue_.open(case_.scheme).driver().create(values.data()));
  auto wiring = make_wiring(); // a driver may look at it in define; the connections are already made
  driver_->define(wiring);
  config::drop_declined_offers(wiring, case_, catalogue_);
  return wiring;
}

} // namespace mullion::run
