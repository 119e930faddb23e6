// The windows of a session: those that the modules made are adopted, companions and driver/state are made from the
// driver's wiring, and who reads whom in place is noted, so that calls that must not run at the same time are refused.
#include "log/console.hpp"
#include "process/supervisor.hpp"
#include "run/session.hpp"
#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <map>
#include <unistd.h>

namespace mullion::run {

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
  const double offset = module == shm::no_module ? 0.0 : modules_[module].clock_offset;
  shm::initialise_levels(control_, id, n_slots, case_.start_time + offset, case_.dt);
  control_.n_windows = id + 1;
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
        fail_by_end(module, process::describe_end(module.host->wait_status));
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
  list_function_windows(m);
}

void Session::list_function_windows(std::uint32_t m)
{
  auto& module = modules_[m];
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

void Session::find_ledger()
{
  // Interface windows on which both sides count their work.
  const auto find = [&](const std::string& port) -> std::optional<LedgerSide> {
    auto name = port;
    name[name.find('.')] = '/';
    LedgerSide side;
    side.window = control_.find_window(name);
    const auto& view = windows_.view(side.window);
    const int work = view.find_field(0, "work"), impulse = view.find_field(0, "impulse");
    const auto is_pane_output = [&](int field) {
      return field >= 0 && view.fields()[field].location == MULLION_PANE && view.fields()[field].role == MULLION_OUTPUT;
    };
    if (!is_pane_output(work) || view.header().n_panes != 1) return std::nullopt;
    side.work = {side.window, static_cast<std::uint32_t>(work)};
    if (is_pane_output(impulse)) side.impulse = FieldAddress{side.window, static_cast<std::uint32_t>(impulse)};
    return side;
  };
  if (case_.interfaces.size() != 1) return;
  const auto fluid = find(case_.interfaces[0].fluid), structure = find(case_.interfaces[0].structure);
  if (!fluid || !structure) return;
  Ledger ledger{*fluid, *structure};
  if (fluid->impulse && structure->impulse) {
    const auto components = [&](const FieldAddress& at) {
      return windows_.view(at.window).fields()[at.field].components;
    };
    if (components(*fluid->impulse) == components(*structure->impulse))
      ledger.n_components = components(*fluid->impulse);
  }
  ledger_ = ledger;
}

void Session::make_driver_state()
{
  find_ledger();
  if (wiring_->states.empty() && wiring_->squares.empty() && !ledger_) return;
  shm::WindowPlan plan;
  plan.name = "driver/state";
  plan.n_slots = static_cast<std::uint32_t>(wiring_->committed_state_levels) + 1;
  plan.panes.push_back({0, 0, 0, nullptr, nullptr, 0, 1});
  const auto add = [&](const std::string& name, const std::string& unit, std::uint32_t components,
                       std::int64_t entities) {
    shm::FieldPlan field;
    field.name = name;
    field.unit = unit;
    field.location = MULLION_PANE;
    field.components = components;
    field.entities = entities;
    plan.fields.push_back(std::move(field));
  };
  const auto record_of = [&](const std::string& port) {
    FieldAddress like{};
    try {
      like = find_field(port, true, 0);
    } catch (const Error&) {
      like = find_field(port, false, 0);
    }
    return windows_.view(like.window).fields()[like.field];
  };
  for (const auto& state : wiring_->states) {
    if (state.like.empty()) {
      add(state.name, "1", 1, state.size);
      continue;
    }
    const auto like = record_of(state.like);
    add(state.name, like.unit, like.components, like.entities * state.size);
  }
  for (const auto& square : wiring_->squares) {
    std::int64_t rows = 0;
    for (const auto& port : square.like) {
      const auto like = record_of(port);
      rows += like.components * like.entities;
    }
    add(square.name, "1", 1, rows <= square.largest ? rows * rows : 1);
  }
  if (ledger_) add(ledger_field, "1", 1, ledger_size(*ledger_));
  plan.dimension = 1;
  make_window(plan, shm::no_module);
  state_window_ = control_.n_windows - 1;
  if (ledger_) ledger_->state = find_state(ledger_field);
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
