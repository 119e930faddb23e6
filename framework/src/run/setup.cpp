// How a session comes to life: modules described in the control object, hosts spawned, windows defined and adopted,
// companions and driver/state made from the driver's wiring, everything attached, the first exchange made.
#include "config/parameter_table.hpp"
#include "log/console.hpp"
#include "run/session.hpp"
#include "shm/levels.hpp"

#include <mullion/coupling/driver_plugin.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cstring>
#include <map>
#include <unistd.h>

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
      windows_(control, shm::no_module, true), modules_(the_case.modules.size())
{
}

Session::~Session()
{
  driver_.reset();
  for (auto& module : modules_)
    if (module.host != nullptr) supervisor_.kill(*module.host);
}

void Session::start_fresh()
{
  const TimeStep initial{0, case_.start_time, case_.start_time, case_.dt, 0};
  describe_modules();
  for (std::uint32_t m = 0; m < modules_.size(); ++m) spawn(m);
  call_all(Operation::create, initial);
  for (std::uint32_t m = 0; m < modules_.size(); ++m) { // in order: mesh motion and transfer look at the solvers
    call(m, Operation::define, initial);
    adopt_windows(m);
  }
  make_companions();
  make_driver_state();
  find_conflicts();
  make_driver();
  call_all(Operation::attach, initial);
  Coupling coupling(this);
  driver_->attach(coupling);

  shm::roll_back(control_);
  if (state_window_ != shm::no_window) control_.working[state_window_].is_written = 1;
  driver_->start(initial);
  for (std::uint32_t m = 0; m < modules_.size(); ++m) await(m);
  call_all(Operation::seal, initial);
  const auto& table = control_.table(control_.epoch.load());
  for (std::uint32_t w = 0; w < control_.n_windows; ++w)
    if (control_.windows[w].owner == shm::Owner::orchestrator) shm::seal(windows_.view(w), table.windows[w]);
  shm::roll_back(control_);
  is_running_ = true;
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

std::string Session::recover()
{
  std::vector<std::uint32_t> dead;
  std::string names;
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    try {
      await(m);
    } catch (const Error& error) {
      log::debug("run", "while recovering: {}", error.what());
    }
    if (modules_[m].host == nullptr || !modules_[m].host->is_dead) continue;
    dead.push_back(m);
    names += (names.empty() ? "'" : ", '") + modules_[m].config->instance + "'";
  }
  if (!dead.empty()) attach_again(dead);
  return names;
}

void Session::attach_again(const std::vector<std::uint32_t>& modules)
{
  const TimeStep at{control_.step.load(), control_.time.load(), control_.time.load(), case_.dt, 0};
  is_running_ = false; // the start-up deadline holds
  shm::roll_back(control_);
  for (const auto m : modules) spawn(m);
  for (const auto operation : {Operation::create, Operation::attach}) {
    for (const auto m : modules) begin(m, operation, 0, at, at.end);
    for (const auto m : modules) await(m);
  }
  make_driver();
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
  needs_constant_step_ = wiring_->needs_constant_step;

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
    copy(record.plugin, module.config->plugin, "plug-in name");
    copy(record.path, module.config->path, "plug-in path");
    record.is_inline = module.config->is_process ? 0 : 1;
    for (const auto& pair : wiring_->interfaces())
      for (const auto& path : {pair.fluid, pair.structure})
        if (const auto [instance, window] = split_window(path); instance == module.config->instance)
          copy(record.interface_window, window, "window name");
    for (const auto& history : wiring_->histories)
      if (const auto [instance, window] = split_window(history.window); instance == module.config->instance) {
        auto& slot = record.histories[record.n_histories++];
        copy(slot.window, window, "window name");
        slot.n_slots = static_cast<std::uint32_t>(history.committed_levels) + 1;
      }
    MULLION_REQUIRE(module.config->parameters.size() <= shm::max_parameters, Errc::config,
                    "plug-in {} has more than {} parameters", module.config->plugin, shm::max_parameters);
    std::size_t used = 1; // offset 0 is the empty text
    for (const auto& value : config::to_values(module.config->parameters)) {
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
    module.timings.push_back({"step"});
    for (std::uint32_t f = 0; f < module.entries->n_functions; ++f)
      module.timings.push_back({module.entries->functions[f].name});
    control_.n_modules = m + 1;
  }
}

void Session::spawn(std::uint32_t m)
{
  auto& module = modules_[m];
  if (module.config->is_process) {
    module.host = supervisor_.spawn(m);
    return;
  }
  windows_.allow(m);
  module.runtime = std::make_unique<module::ModuleRuntime>(
      windows_, m, [name = module.config->instance](std::uint32_t level, const std::string& text) {
        constexpr log::Level levels[] = {log::Level::debug, log::Level::debug, log::Level::info, log::Level::warning,
                                         log::Level::error};
        log::write(levels[std::min(level, 4u)], name, text);
      });
}

void Session::call(std::uint32_t module, Operation operation, const TimeStep& step)
{
  begin(module, operation, 0, step, step.end);
  await(module);
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

void Session::make_driver()
{
  const auto values = config::to_values(case_.driver_parameters);
  driver_.reset(catalogue_.open(case_.scheme).driver().create(values.data()));
  auto wiring = make_wiring(); // a driver may look at it in define; the connections are already made
  driver_->define(wiring);
}

// ---- windows -----------------------------------------------------------------------------------------------------

std::uint32_t Session::register_window(const std::string& name, shm::Owner owner, std::uint32_t module,
                                       shm::Descriptor object, std::uint64_t bytes, std::uint32_t n_slots)
{
  MULLION_REQUIRE(control_.n_windows < shm::max_windows, Errc::config, "a run has at most {} windows",
                  shm::max_windows);
  const auto id = control_.n_windows;
  auto& record = control_.windows[id];
  shm::copy_text(record.name, sizeof record.name, name, "window name");
  record.owner = owner;
  record.module = module;
  record.fd = object.get();
  record.generation = 1;
  record.bytes = bytes;
  objects_.push_back(std::move(object));
  shm::initialise_levels(control_, id, n_slots, case_.start_time, case_.dt);
  control_.n_windows = id + 1;
  control_.directory_version.fetch_add(1, std::memory_order_release);
  log::debug("run", "window {}: {}, {} levels", name, shm::human_bytes(bytes), n_slots);
  return id;
}

void Session::adopt_windows(std::uint32_t m)
{
  auto& module = modules_[m];
  const auto adopt = [&](const std::string& name, shm::Descriptor object, std::uint64_t bytes, std::uint32_t n_slots) {
    module.windows.push_back(register_window(name, shm::Owner::module, m, std::move(object), bytes, n_slots));
  };
  for (auto& window : module.defined)
    adopt(window.name, std::move(window.object), window.mapping.bytes, window.view.header().n_slots);
  module.defined.clear();
  if (module.host != nullptr) {
    const auto& reply = module.host->reply();
    for (std::uint32_t i = 0; i < std::min(reply.n_windows, shm::max_own_windows); ++i) {
      shm::Descriptor object;
      try {
        object = shm::adopt_object(module.host->pid, reply.windows[i].fd);
      } catch (const Error&) { // it died meanwhile, or it gave us nonsense: then this ends it
        supervisor_.kill(*module.host);
        fail(module, Errc::process, process::describe_end(module.host->wait_status));
      }
      adopt(reply.windows[i].name, std::move(object), reply.windows[i].bytes, reply.windows[i].n_slots);
    }
  }
  for (const auto w : module.windows) { // checked here, before anyone believes in them
    try {
      (void)windows_.view(w);
    } catch (const Error& error) {
      throw Error(error.code(), fmt::format("{} made a bad window: {}", who(module), error.what()));
    }
  }
  for (std::uint32_t f = 0; f < module.entries->n_functions; ++f) {
    const std::string written = module.entries->functions[f].writes;
    auto& windows = module.function_windows.emplace_back();
    if (written.empty()) continue;
    const auto id = control_.find_window(module.config->instance + "/" + written);
    MULLION_REQUIRE(id != shm::no_window, Errc::shape,
                    "module '{}': its function '{}' writes window '{}', which it did "
                    "not make",
                    module.config->instance, module.entries->functions[f].name, written);
    windows.push_back(id);
  }
}

void Session::make_window(const shm::WindowPlan& plan, std::uint32_t module)
{
  const auto bytes = shm::window_bytes(plan);
  auto object = shm::create_object(plan.name, bytes);
  const auto mapping = shm::map_object(::getpid(), object.get(), shm::Access::read_write);
  shm::write_window(plan, mapping.data, mapping.bytes);
  register_window(plan.name, shm::Owner::orchestrator, module, std::move(object), bytes, plan.n_slots);
}

void Session::make_companions()
{
  std::map<std::string, std::vector<const Connection*>> by_window; // "structure/wet"
  for (const auto& connection : wiring_->connections) {
    const auto last = connection.receiver.rfind('.');
    auto window = connection.receiver.substr(0, last);
    window[window.find('.')] = '/';
    by_window[window].push_back(&connection);
  }
  for (const auto& [parent, connections] : by_window) {
    const auto parent_id = control_.find_window(parent);
    MULLION_REQUIRE(parent_id != shm::no_window, Errc::config, "driver {}: there is no window {}", case_.scheme,
                    parent);
    const auto& parent_view = windows_.view(parent_id);
    const auto m = control_.windows[parent_id].module;
    shm::WindowPlan plan;
    plan.name = parent + ".in";
    plan.dimension = parent_view.header().dimension;
    for (std::uint32_t p = 0; p < parent_view.header().n_panes; ++p) {
      const auto& pane = parent_view.panes()[p];
      plan.panes.push_back({pane.id, pane.n_nodes, pane.n_elements, nullptr, nullptr, 0, plan.dimension});
      for (const auto* connection : connections) {
        const auto name = connection->receiver.substr(connection->receiver.rfind('.') + 1);
        const mullion_input_spec* spec = nullptr;
        for (std::uint32_t i = 0; i < modules_[m].entries->n_inputs; ++i) {
          const auto& input = modules_[m].entries->inputs[i];
          if (name == input.name && parent == modules_[m].config->instance + "/" + input.window) spec = &input;
        }
        MULLION_REQUIRE(spec != nullptr, Errc::config, "driver {}: module '{}' receives no field '{}' on {}",
                        case_.scheme, modules_[m].config->instance, name, parent);
        shm::FieldPlan field;
        field.name = name;
        field.unit = spec->unit;
        field.pane = p;
        field.location = spec->location;
        field.components = spec->components == 0 ? plan.dimension : spec->components;
        field.role = MULLION_STATE;
        field.nature = spec->nature;
        field.carry = MULLION_OVERWRITE;
        field.entities = spec->location == MULLION_NODE      ? pane.n_nodes
                         : spec->location == MULLION_ELEMENT ? pane.n_elements
                                                             : 1;
        field.policy = static_cast<std::uint32_t>(connection->policy);
        if (!connection->source.empty()) {
          const auto source = find_field(connection->source, false, p);
          const auto& record = windows_.view(source.window).fields()[source.field];
          MULLION_REQUIRE(record.entities == field.entities && record.components == field.components, Errc::shape,
                          "{} ({} x {}) cannot feed {} ({} x {}): a bound field needs the same shape (components x "
                          "entities); the two meshes differ",
                          connection->source, record.components, record.entities, connection->receiver,
                          field.components, field.entities);
          field.storage = shm::Storage::bound;
          field.source_window = source.window;
          field.source_field = source.field;
          exchange(source);
        } else {
          plan.n_slots = std::max(plan.n_slots, static_cast<std::uint32_t>(connection->levels));
        }
        plan.fields.push_back(std::move(field));
      }
    }
    make_window(plan, m);
  }
}

void Session::make_driver_state()
{
  if (wiring_->states.empty()) return;
  shm::WindowPlan plan;
  plan.name = "driver/state";
  plan.n_slots = static_cast<std::uint32_t>(wiring_->committed_state_levels) + 1;
  plan.panes.push_back({0, 0, 0, nullptr, nullptr, 0, 1});
  for (const auto& state : wiring_->states) {
    shm::FieldPlan field;
    field.name = state.name;
    field.unit.assign(1, '1'); // assign(const char*) here trips g++ 12's -Wrestrict
    field.location = MULLION_PANE;
    field.entities = state.size;
    if (!state.like.empty()) {
      FieldAddress like{};
      try {
        like = find_field(state.like, true, 0);
      } catch (const Error&) {
        like = find_field(state.like, false, 0);
      }
      const auto& record = windows_.view(like.window).fields()[like.field];
      field.components = record.components;
      field.entities = record.entities;
      field.unit = record.unit;
    }
    plan.fields.push_back(std::move(field));
  }
  plan.dimension = 1;
  make_window(plan, shm::no_module);
  state_window_ = control_.n_windows - 1;
}

void Session::find_conflicts()
{
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    const auto& record = control_.windows[w];
    if (record.owner != shm::Owner::orchestrator || record.module == shm::no_module) continue;
    for (const auto& field : windows_.view(w).fields()) {
      if (static_cast<shm::Storage>(field.storage) != shm::Storage::bound) continue;
      const auto source = control_.windows[field.source_window].module;
      if (source == record.module) continue;
      modules_[record.module].conflicts |= 1u << source;
      modules_[source].conflicts |= 1u << record.module;
    }
  }
}

} // namespace mullion::run
