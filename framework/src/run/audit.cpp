#include "run/audit.hpp"

#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <cstring>

namespace mullion::run {

void Audit::keep(Session& session)
{
  auto& control = session.control();
  const auto epoch = control.epoch.load();
  kept_.clear();
  for (const auto w : session.write_order()) {
    if (control.working[w].is_written == 0) continue;
    const auto fields = session.windows().view(w).fields();
    for (std::uint32_t f = 0; f < fields.size(); ++f) {
      const auto bytes = shm::field_bytes(fields[f]);
      if (static_cast<shm::Storage>(fields[f].storage) == shm::Storage::bound || bytes == 0) continue;
      const auto* data = session.windows().locate(w, f, 0, epoch).data;
      kept_.push_back({w, f, {data, data + bytes}});
    }
  }
}

void Audit::compare(Session& session, const TimeStep& step, const char* how) const
{
  auto& control = session.control();
  for (const auto& kept : kept_) {
    const auto at = session.windows().locate(kept.window, kept.field, 0, control.epoch.load());
    if (std::memcmp(at.data, kept.bytes.data(), kept.bytes.size()) == 0) continue;
    const auto size = shm::scalar_bytes(at.field->scalar);
    std::size_t i = 0;
    while (std::memcmp(at.data + i * size, kept.bytes.data() + i * size, size) == 0) ++i;
    double first = 0, second = 0;
    if (at.field->scalar == MULLION_F64) {
      std::memcpy(&first, kept.bytes.data() + i * size, size);
      std::memcpy(&second, at.data + i * size, size);
    }
    const auto& window = control.windows[kept.window];
    const std::string owner = window.module == shm::no_module || window.owner == shm::Owner::orchestrator
                                  ? "driver " + session.the_case().scheme
                                  : fmt::format("module '{}' ({})", control.modules[window.module].name,
                                                control.modules[window.module].plugin);
    throw Error(
        Errc::internal,
        fmt::format("step {} done again by {} differs: {}.{}[{}, {}] (component, entity) was {} and is now {}; {} "
                    "keeps state outside its windows",
                    step.index, how, window.name, at.field->name, i % at.field->components, i / at.field->components,
                    first, second, owner));
  }
}

} // namespace mullion::run
