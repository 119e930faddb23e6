// The services that a module sees through the C boundary: making windows, looking at peers, handles, views and received
// fields. Each failure becomes a status and a text; nothing is thrown across the boundary.
#include "module/module_runtime.hpp"

#include <mullion/sdk/error.hpp>

#include <cstring>
#include <exception>
#include <unistd.h>

namespace mullion::module {

using shm::Storage;

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
  if (phase_ == Phase::attaching && static_cast<Storage>(at.field->storage) == Storage::level)
    has_attached_to_levels_ = true;
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
