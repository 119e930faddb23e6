#include "module/module_runtime.hpp"

#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <set>
#include <unistd.h>

namespace mullion::module {

using shm::FieldRecord;
using shm::Storage;

struct ModuleRuntime::PhaseGuard {
  PhaseGuard(ModuleRuntime& runtime, Phase phase) : runtime_(runtime) { runtime.phase_ = phase; }
  ~PhaseGuard() { runtime_.phase_ = Phase::idle; }
  ModuleRuntime& runtime_;
};

ModuleRuntime::ModuleRuntime(shm::WindowMap& windows, std::uint32_t module, LogSink log)
    : windows_(windows), module_(module), log_(std::move(log))
{
}

ModuleRuntime::~ModuleRuntime()
{
  if (instance_ != nullptr) entries_->destroy(instance_);
}

void ModuleRuntime::require(std::int32_t status)
{
  if (status != MULLION_OK) throw Error(static_cast<Errc>(status), error_);
}

void ModuleRuntime::invoke(std::int32_t (*entry)(void*, const mullion_step*), const mullion_step& step)
{
  error_ = "failed without saying why";
  require(entry(instance_, &step));
}

// ---- life ----------------------------------------------------------------------------------------------------

void ModuleRuntime::create()
{
  library_.emplace(record().path);
  MULLION_REQUIRE(!library_->is_driver(), Errc::plugin, "plug-in {} is a driver, not a module", record().path);
  entries_ = &library_->module();
  MULLION_REQUIRE(entries_->n_parameters == record().n_parameters, Errc::plugin,
                  "plug-in {} declares {} parameters, it declared {} when the case was read: the file changed; "
                  "start again",
                  record().path, entries_->n_parameters, record().n_parameters);
  std::array<mullion_value, shm::max_parameters> values{};
  for (std::uint32_t i = 0; i < record().n_parameters; ++i) {
    const auto& p = record().parameters[i];
    values[i] = {p.real, p.integer, record().text + p.text_offset};
  }
  error_ = "failed without saying why";
  require(entries_->create(this, &services, values.data(), &instance_));
}

std::vector<ModuleRuntime::Defined> ModuleRuntime::define(const mullion_step& initial)
{
  const PhaseGuard guard(*this, Phase::defining);
  handles_.clear();
  defined_.clear();
  invoke(entries_->define, initial);
  std::set<std::string> declared;
  for (std::uint32_t i = 0; i < entries_->n_fields; ++i) declared.insert(entries_->fields[i].window);
  for (std::uint32_t i = 0; i < entries_->n_inputs; ++i) declared.insert(entries_->inputs[i].window);
  for (const auto& window : declared) {
    const auto name = fmt::format("{}/{}", record().name, window);
    MULLION_REQUIRE(std::any_of(defined_.begin(), defined_.end(), [&](const auto& d) { return d.name == name; }),
                    Errc::shape, "its define made no window '{}', which it declares", window);
  }
  shm::LevelEntry levels{};
  for (const auto& window : defined_) {
    (void)shm::WindowView(window.mapping.data, window.mapping.bytes, window.name); // the module wrote there meanwhile
    levels.n_slots = window.view.header().n_slots;
    shm::seal(window.view, levels);
  }
  handles_.clear();
  return std::move(defined_);
}

void ModuleRuntime::attach()
{
  const PhaseGuard guard(*this, Phase::attaching);
  epoch_ = windows_.control().epoch.load(std::memory_order_acquire);
  handles_.clear();
  list_windows();
  error_ = "failed without saying why";
  require(entries_->attach(instance_));
}

void ModuleRuntime::start(const mullion_step& initial)
{
  const PhaseGuard guard(*this, Phase::starting);
  epoch_ = windows_.control().epoch.load(std::memory_order_acquire);
  invoke(entries_->start, initial);
  check_finite(own_windows_);
}

void ModuleRuntime::seal()
{
  for (const auto w : own_windows_) shm::seal(windows_.view(w), windows_.control().table(epoch_).windows[w]);
}

void ModuleRuntime::run(const shm::Request& request, double* results)
{
  const PhaseGuard guard(*this, Phase::stepping);
  epoch_ = request.epoch;
  const auto& written = windows_written_by(request);
  const auto& table = windows_.control().table(epoch_);
  for (const auto w : written) {
    if ((request.flags & shm::poison) != 0) shm::poison_working(windows_.view(w), table.windows[w]);
    if ((request.flags & shm::arm_state) != 0) shm::arm(windows_.view(w), table.windows[w]);
  }
  if (request.operation == shm::Operation::step) {
    invoke(entries_->step, request.step);
  } else {
    error_ = "failed without saying why";
    require(entries_->call(instance_, request.function, &request.step, request.arguments, results));
  }
  if ((request.flags & shm::check_written) != 0) check_written(written);
  check_finite(written);
}

// ---- checks --------------------------------------------------------------------------------------------------

std::uint32_t ModuleRuntime::own_window(const std::string& name) const
{
  return windows_.control().find_window(fmt::format("{}/{}", record().name, name));
}

void ModuleRuntime::list_windows()
{
  const auto& control = windows_.control();
  own_windows_.clear();
  function_windows_.assign(entries_->n_functions, {});
  for (std::uint32_t w = 0; w < control.n_windows; ++w)
    if (control.windows[w].owner == shm::Owner::module && control.windows[w].module == module_)
      own_windows_.push_back(w);
  for (std::uint32_t f = 0; f < entries_->n_functions; ++f)
    if (const std::string window = entries_->functions[f].writes; !window.empty())
      function_windows_[f].push_back(own_window(window)); // it exists: the orchestrator checked that after define
}

const std::vector<std::uint32_t>& ModuleRuntime::windows_written_by(const shm::Request& request) const
{
  if (request.operation == shm::Operation::step) return own_windows_;
  MULLION_ASSERT(request.function < function_windows_.size(), "function {}", request.function);
  return function_windows_[request.function];
}

void ModuleRuntime::check_written(const std::vector<std::uint32_t>& windows)
{
  for (const auto w : windows)
    if (const auto entry = shm::find_poison(windows_.view(w), windows_.control().table(epoch_).windows[w]))
      throw Error(Errc::internal,
                  fmt::format("{}.{} was never written by this call; outputs and overwritten state must be "
                              "written whole each time",
                              windows_.control().windows[w].name, *entry));
}

void ModuleRuntime::check_finite(const std::vector<std::uint32_t>& windows)
{
  for (std::uint32_t i = 0; i < record().n_exchanged; ++i) {
    const auto [window, field] = record().exchanged[i];
    if (std::find(windows.begin(), windows.end(), window) == windows.end()) continue;
    const auto at = windows_.locate(window, field, 0, epoch_);
    if (at.field->scalar != MULLION_F64) continue;
    const auto* values = reinterpret_cast<const double*>(at.data);
    const auto bad = shm::first_not_finite(values, at.field->entities * at.field->components);
    MULLION_REQUIRE(bad < 0, Errc::numeric, "{}.{}[{}, {}] = {} (component, entity): not a finite number",
                    windows_.control().windows[window].name, at.field->name, bad % at.field->components,
                    bad / at.field->components, values[bad]);
  }
}

// ---- services --------------------------------------------------------------------------------------------------

template <class Body> std::int32_t ModuleRuntime::serve(void* context, Body&& body)
{
  auto& self = *static_cast<ModuleRuntime*>(context);
  try {
    body(self);
    return MULLION_OK;
  } catch (const Error& error) {
    self.error_ = error.what();
    return static_cast<std::int32_t>(error.code());
  } catch (const std::exception& error) {
    self.error_ = error.what();
    return static_cast<std::int32_t>(Errc::internal);
  }
}

const mullion_services ModuleRuntime::services = {
    MULLION_ABI,
    sizeof(mullion_services),
    [](void* c, const char* window, const mullion_pane* panes, std::uint32_t n) {
      return serve(c, [&](ModuleRuntime& self) { self.make_window(window, panes, n); });
    },
    [](void* c, const char* kind, const char* window, std::uint32_t pane, mullion_pane* out) {
      return serve(c, [&](ModuleRuntime& self) { *out = self.peer(kind, window, pane).pane(pane, self.blocks_); });
    },
    [](void* c, const char* kind, const char* window, std::uint32_t pane, const char* name, mullion_array* out) {
      return serve(c, [&](ModuleRuntime& self) {
        const auto& view = self.peer(kind, window, pane);
        const int f = view.find_field(pane, name);
        MULLION_REQUIRE(f >= 0 && static_cast<Storage>(view.fields()[f].storage) == Storage::fixed, Errc::shape,
                        "the {}'s window {} has no fixed field '{}'", kind, view.header().name, name);
        const auto& field = view.fields()[f];
        *out = {view.data(field, 0), field.components, field.entities, field.scalar, 0};
      });
    },
    [](void* c, const char* window, std::uint32_t pane, mullion_pane* out) {
      return serve(c, [&](ModuleRuntime& self) { self.own_pane(window, pane, out); });
    },
    [](void* c, const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle) {
      return serve(c, [&](ModuleRuntime& self) { self.find_field(window, pane, name, handle); });
    },
    [](void* c, std::uint32_t handle, std::int32_t level, mullion_array* out) {
      return serve(c, [&](ModuleRuntime& self) { self.view(handle, level, out); });
    },
    [](void* c, const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle) {
      return serve(c, [&](ModuleRuntime& self) { self.find_input(window, pane, name, handle); });
    },
    [](void* c, std::uint32_t handle, mullion_received* out) {
      return serve(c, [&](ModuleRuntime& self) { self.received(handle, out); });
    },
    [](void* c) { return static_cast<ModuleRuntime*>(c)->error_.c_str(); },
    [](void* c, std::int32_t, const char* text) { static_cast<ModuleRuntime*>(c)->error_ = text; },
    [](void* c, std::uint32_t level, const char* text) { static_cast<ModuleRuntime*>(c)->log_(level, text); }};

void ModuleRuntime::make_window(const char* window, const mullion_pane* panes, std::uint32_t n_panes)
{
  MULLION_REQUIRE(phase_ == Phase::defining, Errc::internal, "windows are made in define only");
  shm::WindowPlan plan;
  plan.name = fmt::format("{}/{}", record().name, window);
  for (const auto& other : defined_)
    MULLION_REQUIRE(other.name != plan.name, Errc::shape, "its define made window '{}' twice", window);
  MULLION_REQUIRE(defined_.size() < shm::max_own_windows, Errc::shape, "a module has at most {} windows",
                  shm::max_own_windows);
  MULLION_REQUIRE(n_panes >= 1, Errc::shape, "window '{}' was made without a pane", window);
  plan.panes.assign(panes, panes + n_panes);
  plan.dimension = panes[0].dimension;
  MULLION_REQUIRE(1 <= plan.dimension && plan.dimension <= 3, Errc::shape,
                  "window '{}' has {} coordinates a node, expected 1, 2 or 3", window, plan.dimension);
  for (std::uint32_t i = 0; i < record().n_histories; ++i)
    if (plan.name == fmt::format("{}/{}", record().name, record().histories[i].window))
      plan.n_slots = record().histories[i].n_slots;

  bool is_declared = false;
  for (std::uint32_t i = 0; i < entries_->n_inputs; ++i)
    is_declared |= !std::strcmp(entries_->inputs[i].window, window);
  for (std::uint32_t p = 0; p < n_panes; ++p) {
    MULLION_REQUIRE(panes[p].dimension == plan.dimension, Errc::shape, "the panes of window '{}' differ in dimension",
                    window);
    for (std::uint32_t i = 0; i < entries_->n_fields; ++i) {
      const auto& spec = entries_->fields[i];
      if (std::strcmp(spec.window, window) != 0) continue;
      is_declared = true;
      shm::FieldPlan field;
      field.name = spec.name;
      field.unit = spec.unit;
      field.pane = p;
      field.location = spec.location;
      field.components = spec.components == 0 ? plan.dimension : spec.components;
      field.role = spec.role;
      field.nature = spec.nature;
      field.carry = spec.carry;
      field.scalar = spec.scalar;
      field.storage = spec.role == MULLION_FIXED ? Storage::fixed : Storage::level;
      field.entities = spec.location == MULLION_NODE      ? panes[p].n_nodes
                       : spec.location == MULLION_ELEMENT ? panes[p].n_elements
                                                          : 1;
      plan.fields.push_back(std::move(field));
    }
  }
  MULLION_REQUIRE(is_declared, Errc::shape, "window '{}' is not among the windows that it declares", window);

  Defined defined;
  defined.name = plan.name;
  const auto bytes = shm::window_bytes(plan);
  defined.object = shm::create_object(plan.name, bytes);
  defined.mapping = shm::map_object(::getpid(), defined.object.get(), shm::Access::read_write);
  shm::write_window(plan, defined.mapping.data, defined.mapping.bytes);
  defined.view = shm::WindowView(defined.mapping.data, defined.mapping.bytes, plan.name);
  defined_.push_back(std::move(defined));
}

const shm::WindowView& ModuleRuntime::peer(const char* kind, const char* window, std::uint32_t pane)
{
  MULLION_REQUIRE(phase_ == Phase::defining, Errc::internal,
                  "other modules' windows can be read in define only; keep what is needed in an own window");
  const auto& control = windows_.control();
  for (std::uint32_t m = 0; m < control.n_modules; ++m) {
    const auto& other = control.modules[m];
    if (std::strcmp(other.kind, kind) != 0) continue;
    const std::string name = window[0] == '\0' ? other.interface_window : window;
    const auto id = control.find_window(fmt::format("{}/{}", other.name, name));
    MULLION_REQUIRE(id != shm::no_window, Errc::shape, "the {} '{}' has no window '{}'", kind, other.name, name);
    const auto& view = windows_.view(id);
    MULLION_REQUIRE(pane < view.header().n_panes, Errc::shape, "window {} has {} panes, number {} was asked for",
                    view.header().name, view.header().n_panes, pane);
    return view;
  }
  throw Error(Errc::config, fmt::format("it needs a {} in the case, there is none", kind));
}

void ModuleRuntime::own_pane(const char* window, std::uint32_t pane, mullion_pane* out)
{
  const shm::WindowView* view = nullptr;
  if (phase_ == Phase::defining) {
    for (const auto& d : defined_)
      if (d.name == fmt::format("{}/{}", record().name, window)) view = &d.view;
  } else if (const auto id = own_window(window); id != shm::no_window) {
    view = &windows_.view(id);
  }
  MULLION_REQUIRE(view != nullptr, Errc::shape, "it asked for the mesh of its window '{}', which does not exist",
                  window);
  MULLION_REQUIRE(pane < view->header().n_panes, Errc::shape, "window '{}' has no pane {}", window, pane);
  *out = view->pane(pane, blocks_);
}

void ModuleRuntime::find_field(const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle)
{
  Handle found{shm::no_window, 0};
  const shm::WindowView* view = nullptr;
  if (phase_ == Phase::defining) {
    for (std::size_t d = 0; d < defined_.size(); ++d)
      if (defined_[d].name == fmt::format("{}/{}", record().name, window)) {
        found.window = static_cast<std::uint32_t>(d);
        view = &defined_[d].view;
      }
  } else {
    found.window = own_window(window);
    if (found.window != shm::no_window) view = &windows_.view(found.window);
  }
  MULLION_REQUIRE(view != nullptr, Errc::shape, "it asked for the field {}.{}, but has no window '{}'", window, name,
                  window);
  const int f = view->find_field(pane, name);
  MULLION_REQUIRE(f >= 0, Errc::shape, "it asked for the field {}.{}, which it does not declare", window, name);
  found.field = static_cast<std::uint32_t>(f);
  *handle = static_cast<std::uint32_t>(handles_.size());
  handles_.push_back(found);
}

void ModuleRuntime::find_input(const char* window, std::uint32_t pane, const char* name, std::uint32_t* handle)
{
  *handle = MULLION_UNCONNECTED;
  if (phase_ == Phase::defining) return;
  const auto companion = own_window(std::string(window) + ".in");
  if (companion == shm::no_window) return;
  const int f = windows_.view(companion).find_field(pane, name);
  if (f < 0) return;
  *handle = static_cast<std::uint32_t>(handles_.size());
  handles_.push_back({companion, static_cast<std::uint32_t>(f)});
}

void ModuleRuntime::view(std::uint32_t handle, std::int32_t level, mullion_array* out)
{
  MULLION_REQUIRE(handle < handles_.size(), Errc::internal, "it used a field that this attach never looked up");
  const auto [window, index] = handles_[handle];
  if (phase_ == Phase::defining) {
    const auto& view = defined_[window].view;
    const auto& field = view.fields()[index];
    *out = {view.data(field, 0), field.components, field.entities, field.scalar, 1};
    return;
  }
  MULLION_REQUIRE(phase_ != Phase::idle, Errc::internal, "views exist during calls only");
  // Attach sees what is committed: on a fresh start the first state, later wherever the run is.
  if (phase_ == Phase::attaching && level == 0) level = 1;
  const auto at = windows_.locate(window, index, level, epoch_);
  const bool is_writable = level == 0 && static_cast<Storage>(at.field->storage) == Storage::level;
  *out = {at.data, at.field->components, at.field->entities, at.field->scalar, is_writable ? 1u : 0u};
}

void ModuleRuntime::received(std::uint32_t handle, mullion_received* out)
{
  MULLION_REQUIRE(handle < handles_.size(), Errc::internal, "it used an input that this attach never looked up");
  MULLION_REQUIRE(phase_ == Phase::starting || phase_ == Phase::stepping, Errc::internal,
                  "received fields can be read in start, step and functions only");
  const auto [window, index] = handles_[handle];
  const auto& control = windows_.control();
  const auto& companion = windows_.view(window).fields()[index];
  const bool is_bound = static_cast<Storage>(companion.storage) == Storage::bound;
  const auto source = is_bound ? companion.source_window : window;
  const auto& levels = control.table(epoch_).windows[source];
  const auto& working = control.working[source];
  MULLION_REQUIRE(is_bound || working.is_written != 0, Errc::shape, "the driver has not written {}.{} in this step",
                  control.windows[window].name, companion.name);
  out->policy = companion.policy;
  out->n_levels = 0;
  const auto add = [&](int level, const mullion_stamp& stamp) {
    const auto at = windows_.locate(window, index, level, epoch_);
    out->stamps[out->n_levels] = stamp;
    out->data[out->n_levels++] = reinterpret_cast<const double*>(at.data);
    out->components = at.field->components;
    out->entities = at.field->entities;
  };
  if (working.is_written != 0) add(0, working.stamp);
  if (phase_ == Phase::starting && out->n_levels > 0) return; // nothing older exists yet
  for (std::uint32_t k = 1; k < levels.n_slots && out->n_levels < MULLION_MAX_LEVELS; ++k)
    add(static_cast<int>(k), levels.committed[k - 1]);
}

} // namespace mullion::module
