// How a session comes to life from a checkpoint: the modules' windows are made from what it holds and handed to the
// modules, companions and driver/state are made anew from the driver's wiring and filled; then everything attaches.
// Nothing of the file is believed that the plug-ins do not declare today in the same way.
#include "run/session.hpp"
#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cstring>
#include <unistd.h>

namespace mullion::run {

using shm::Operation;

namespace {

template <class... T> void require(bool holds, const std::string& window, fmt::format_string<T...> text, T&&... values)
{
  MULLION_REQUIRE(holds, Errc::config, "the checkpoint does not fit: window {} {}", window,
                  fmt::format(text, std::forward<T>(values)...));
}

/// Are the fields of a restored window those that its module declares today?
void check_declared(const shm::WindowView& view, const std::string& name, const mullion_module& entries)
{
  const auto window = name.substr(name.find('/') + 1);
  const auto& header = view.header();
  std::size_t n_declared = 0;
  for (std::uint32_t i = 0; i < entries.n_fields; ++i) {
    const auto& spec = entries.fields[i];
    if (window != spec.window) continue;
    ++n_declared;
    for (std::uint32_t p = 0; p < header.n_panes; ++p) {
      const int f = view.find_field(p, spec.name);
      require(f >= 0, name, "has no field '{}' on pane {}", spec.name, p);
      const auto& field = view.fields()[f];
      const auto& pane = view.panes()[p];
      const auto storage = spec.role == MULLION_FIXED ? shm::Storage::fixed : shm::Storage::level;
      const std::int64_t entities = spec.location == MULLION_NODE      ? pane.n_nodes
                                    : spec.location == MULLION_ELEMENT ? pane.n_elements
                                                                       : 1;
      const bool is_the_same = std::strcmp(field.unit, spec.unit) == 0 && field.location == spec.location &&
                               field.components == (spec.components == 0 ? header.dimension : spec.components) &&
                               field.role == spec.role && field.nature == spec.nature && field.carry == spec.carry &&
                               field.scalar == spec.scalar && field.entities == entities &&
                               static_cast<shm::Storage>(field.storage) == storage;
      require(is_the_same, name, "has a field '{}' that the plug-in declares in another way today", spec.name);
    }
  }
  require(view.fields().size() == n_declared * header.n_panes, name, "has {} fields, the plug-in declares {}",
          view.fields().size(), n_declared * header.n_panes);
}

} // namespace

void Session::start_from(const io::Checkpoint& from, const std::set<std::string>& changed)
{
  const TimeStep at{from.clock.step, from.clock.time, from.clock.time, case_.dt, 0};
  describe_modules();
  for (std::uint32_t m = 0; m < modules_.size(); ++m) spawn(m);
  call_all(Operation::create, at);
  restore_module_windows(from);
  for (std::uint32_t m = 0; m < modules_.size(); ++m)
    if (changed.contains(modules_[m].config->instance)) check_definition(m);
  make_companions();
  make_driver_state();
  restore_own_windows(from);
  control_.step = from.clock.step;
  control_.time = from.clock.time;
  find_conflicts();
  (void)make_driver();
  attach_all(at);
  shm::roll_back(control_);
  is_running_ = true;
}

void Session::restore_levels(std::uint32_t window, const io::CheckpointWindow& from)
{
  for (auto& table : control_.levels) {
    auto& levels = table.windows[window];
    levels.working_slot = from.working_slot;
    std::copy(from.stamps.begin(), from.stamps.end(), std::begin(levels.committed));
  }
}

void Session::restore_module_windows(const io::Checkpoint& from)
{
  for (const auto& window : from.windows) {
    if (window.instance.empty()) continue;
    const auto m = static_cast<std::uint32_t>(
        std::find_if(modules_.begin(), modules_.end(),
                     [&](const auto& module) { return module.config->instance == window.instance; }) -
        modules_.begin());
    require(m < modules_.size(), window.name, "belongs to a module '{}', which the case has not", window.instance);
    const auto slot_bytes = window.levels.front().size();
    const auto bytes = std::max(window.head.size() + window.n_slots * slot_bytes, shm::page);
    auto object = shm::create_object(window.name, bytes);
    const auto mapping = shm::map_object(::getpid(), object.get(), shm::Access::read_write);
    if (!window.head.empty()) std::memcpy(mapping.data, window.head.data(), window.head.size());
    const shm::WindowView view(mapping.data, mapping.bytes, window.name);
    const auto& header = view.header();
    require(header.n_slots == window.n_slots && header.slot_bytes == slot_bytes &&
                header.slots_offset == window.head.size(),
            window.name, "has {} slots of {} bytes behind {}, its schema says {} of {} behind {}", window.n_slots,
            slot_bytes, window.head.size(), header.n_slots, header.slot_bytes, header.slots_offset);
    check_declared(view, window.name, *modules_[m].entries);
    std::uint32_t n_slots = 2;
    const auto& record = control_.modules[m];
    for (std::uint32_t i = 0; i < record.n_histories; ++i)
      if (window.name == fmt::format("{}/{}", record.name, record.histories[i].window))
        n_slots = record.histories[i].n_slots;
    require(header.n_slots == n_slots, window.name, "keeps {} levels, and driver {} asks for {}", header.n_slots,
            case_.scheme, n_slots);
    const shm::LevelEntry levels{window.working_slot, window.n_slots, {}};
    for (std::uint32_t k = 1; k < window.n_slots; ++k)
      if (slot_bytes > 0)
        std::memcpy(view.slot(shm::slot_of(levels, static_cast<int>(k))), window.levels[k - 1].data(), slot_bytes);
    modules_[m].windows.push_back(
        register_window(window.name, shm::Owner::module, m, std::move(object), bytes, window.n_slots));
    restore_levels(modules_[m].windows.back(), window);
  }
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    const auto& entries = *modules_[m].entries;
    const auto needs = [&](const char* window) {
      const auto name = fmt::format("{}/{}", modules_[m].config->instance, window);
      MULLION_REQUIRE(control_.find_window(name) != shm::no_window, Errc::config,
                      "the checkpoint does not fit: it has no window {}, which {} declares", name,
                      modules_[m].config->plugin);
    };
    for (std::uint32_t i = 0; i < entries.n_fields; ++i) needs(entries.fields[i].window);
    for (std::uint32_t i = 0; i < entries.n_inputs; ++i) needs(entries.inputs[i].window);
    modules_[m].function_windows = find_function_windows(modules_[m].config->instance, entries);
  }
}

void Session::restore_own_windows(const io::Checkpoint& from)
{
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    if (control_.windows[w].owner != shm::Owner::orchestrator) continue;
    const std::string name = control_.windows[w].name;
    const auto found = std::find_if(from.windows.begin(), from.windows.end(),
                                    [&](const auto& window) { return window.instance.empty() && window.name == name; });
    require(found != from.windows.end(), name, "is not in it: driver {} was not the scheme then, or had other options",
            case_.scheme);
    const auto& view = windows_.view(w);
    const auto& header = view.header();
    require(found->head.size() == header.slots_offset && found->levels.front().size() == header.slot_bytes &&
                found->n_slots == header.n_slots &&
                std::memcmp(found->head.data(), view.object(), found->head.size()) == 0,
            name, "has other fields or sizes than driver {} with its options makes today", case_.scheme);
    restore_levels(w, *found);
    const auto& levels = control_.table(control_.epoch.load()).windows[w];
    for (std::uint32_t k = 1; k < levels.n_slots; ++k)
      if (header.slot_bytes > 0)
        std::memcpy(view.slot(shm::slot_of(levels, static_cast<int>(k))), found->levels[k - 1].data(),
                    header.slot_bytes);
  }
}

void Session::check_definition(std::uint32_t m)
{
  // With other parameters: would the module make the same windows? What it makes here is looked at and thrown away.
  auto& module = modules_[m];
  const TimeStep initial{0, case_.start_time, case_.start_time, case_.dt, 0};
  call(m, Operation::define, initial);
  const auto compare = [&](const std::string& name, const shm::Mapping& mapping) {
    const auto id = control_.find_window(name);
    require(id != shm::no_window, name, "is not in it, and module '{}' makes it with its new parameters",
            module.config->instance);
    const shm::WindowView made(mapping.data, mapping.bytes, name);
    const auto& kept = windows_.view(id);
    const auto bytes = kept.header().slots_offset;
    require(made.header().slots_offset == bytes && std::memcmp(made.object(), kept.object(), bytes) == 0, name,
            "would have another size, mesh or fixed field with the new parameters of module '{}'; a restart can change "
            "only parameters that leave these as they are",
            module.config->instance);
  };
  for (const auto& window : module.defined) compare(window.name, window.mapping);
  module.defined.clear();
  if (module.host == nullptr) return;
  const auto& reply = module.host->reply();
  for (std::uint32_t i = 0; i < std::min(reply.n_windows, shm::max_own_windows); ++i) {
    const auto object = shm::adopt_object(module.host->pid, reply.windows[i].fd);
    compare(reply.windows[i].name, shm::map_object(::getpid(), object.get(), shm::Access::read_only));
  }
}

} // namespace mullion::run
