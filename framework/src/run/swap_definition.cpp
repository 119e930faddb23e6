// Which parameters may a swap change that no module declares as changeable? Those that shape nothing of what `define`
// made: it is not called again, so a value that only it reads would be accepted and do nothing. Nobody declares which
// these are; instead define is called twice, apart from the run, with the values at work and with the new ones, and
// what it makes is compared and thrown away. As in a restart, sizes, meshes and fixed fields must be those that are
// there; beyond that the first states must be the same.
#include "log/console.hpp"
#include "run/session.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cstring>
#include <unistd.h>
#include <utility>

namespace mullion::run {

using shm::Operation;

/// What a define made: windows by their names, and the memory where they lie.
struct Session::Definition {
  struct Made {
    std::string name;
    shm::Descriptor object;
    shm::Mapping mapping;
    shm::WindowView view;
  };
  std::vector<Made> windows;
};

Session::Definition Session::define_apart(std::uint32_t m, const ModuleCase& config, const mullion_module& entries)
{
  const TimeStep initial{0, case_.start_time, case_.start_time, case_.dt, 0};
  const StandIn stand_in(*this, m, config, entries);
  auto& module = modules_[m];
  describe(m);
  spawn(m);
  call(m, Operation::create, initial);
  call(m, Operation::define, initial);
  Definition definition;
  for (auto& window : module.defined)
    definition.windows.push_back({window.name, std::move(window.object), std::move(window.mapping), window.view});
  if (module.host == nullptr) return definition;
  const auto& reply = module.host->reply();
  for (std::uint32_t i = 0; i < std::min(reply.n_windows, shm::max_own_windows); ++i) {
    auto object = shm::adopt_object(module.host->pid, reply.windows[i].fd);
    auto mapping = shm::map_object(::getpid(), object.get(), shm::Access::read_only);
    const shm::WindowView view(mapping.data, mapping.bytes, reply.windows[i].name);
    definition.windows.push_back({reply.windows[i].name, std::move(object), std::move(mapping), view});
  }
  return definition;
}

namespace {

/// The first field whose first values differ; "" if there is none.
std::string different_field(const shm::WindowView& before, const shm::WindowView& after)
{
  for (const auto& field : before.fields()) {
    if (static_cast<shm::Storage>(field.storage) != shm::Storage::level) continue;
    const auto bytes = shm::field_bytes(field);
    if (bytes > 0 && std::memcmp(before.data(field, 0), after.data(field, 0), bytes) != 0) return field.name;
  }
  return "";
}

} // namespace

void Session::require_same_definition(std::uint32_t m, const ModuleCase& candidate, const mullion_module& entries,
                                      const std::string& changes)
{
  MULLION_ASSERT(!has_trial() && !has_candidate() && n_in_flight_ == 0, "between steps");
  try {
    const auto after = define_apart(m, candidate, entries);
    auto present = candidate;
    present.parameters = modules_[m].config->parameters;
    const auto before = define_apart(m, present, entries);
    MULLION_REQUIRE(before.windows.size() == after.windows.size(), Errc::plugin, "'{}' would make {} windows with {}",
                    candidate.instance, after.windows.size(), changes);
    for (std::size_t w = 0; w < after.windows.size(); ++w) {
      const auto& made = after.windows[w];
      const auto id = control_.find_window(made.name);
      const bool is_there = id != shm::no_window && before.windows[w].name == made.name;
      const auto head = made.view.header().slots_offset;
      MULLION_REQUIRE(is_there && windows_.view(id).header().slots_offset == head &&
                          before.windows[w].view.header().slots_offset == head &&
                          std::memcmp(windows_.view(id).object(), made.view.object(), head) == 0,
                      Errc::plugin,
                      "'{}' ({}): with {} the window {} would have another size, mesh or fixed field; a live run keeps "
                      "these as they are",
                      candidate.instance, candidate.plugin, changes, made.name);
      const auto field = different_field(before.windows[w].view, made.view);
      MULLION_REQUIRE(
          field.empty(), Errc::plugin,
          "'{}' ({}): with {} the first values of {}.{} would be others; a live run is past these, and what "
          "only they depend on would change nothing",
          candidate.instance, candidate.plugin, changes, made.name, field);
    }
  } catch (const std::exception& error) {
    throw Error(Errc::plugin, error.what());
  }
}

} // namespace mullion::run
