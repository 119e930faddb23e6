#include "run/checkpoint.hpp"

#include "io/atomic_file.hpp"
#include "plugin/library.hpp"

#include <mullion/coupling/build_id.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <span>

namespace mullion::run {
namespace {

std::string checksum_of(const std::string& library, std::map<std::string, std::string>& known)
{
  auto& checksum = known[library];
  if (checksum.empty()) {
    const auto content = io::read_text(library);
    checksum = fmt::format("{:016x}", io::crc64(std::as_bytes(std::span(content))));
  }
  return checksum;
}

} // namespace

std::vector<io::CheckpointPlugin> plugins_of(const Case& the_case, std::map<std::string, std::string>& checksums)
{
  std::vector<io::CheckpointPlugin> plugins;
  for (const auto& module : the_case.modules)
    plugins.push_back(
        {module.instance, module.kind, module.plugin, module.version, checksum_of(module.path, checksums)});
  const plugin::Library driver(the_case.scheme_path);
  plugins.push_back(
      {"driver", "driver", the_case.scheme, driver.header().version, checksum_of(the_case.scheme_path, checksums)});
  return plugins;
}

std::vector<std::string> other_plugins(const std::vector<io::CheckpointPlugin>& then,
                                       const std::vector<io::CheckpointPlugin>& now)
{
  std::vector<std::string> others;
  for (const auto& plugin : now) {
    const auto before = std::find_if(then.begin(), then.end(),
                                     [&](const io::CheckpointPlugin& p) { return p.instance == plugin.instance; });
    if (before == then.end() || before->name != plugin.name) continue; // the case says so itself
    if (before->version != plugin.version)
      others.push_back(fmt::format("{}: {} {}, was {}", plugin.instance, plugin.name, plugin.version, before->version));
    else if (before->build != plugin.build)
      others.push_back(fmt::format("{}: another build of {} {}", plugin.instance, plugin.name, plugin.version));
  }
  return others;
}

io::Checkpoint checkpoint_of(Session& session, const StepClock& clock)
{
  auto& control = session.control();
  io::Checkpoint checkpoint;
  checkpoint.run_name = control.run_name;
  checkpoint.case_text = session.case_text();
  checkpoint.version = MULLION_VERSION;
  checkpoint.build = MULLION_BUILD_ID;
  checkpoint.clock = clock.state();
  const auto& table = control.table(control.epoch.load(std::memory_order_relaxed));
  for (std::uint32_t w = 0; w < control.n_windows; ++w) {
    const auto& record = control.windows[w];
    const auto& levels = table.windows[w];
    const auto& view = session.windows().view(w);
    auto& window = checkpoint.windows.emplace_back();
    window.name = record.name;
    if (record.owner == shm::Owner::module) window.instance = control.modules[record.module].name;
    window.n_slots = levels.n_slots;
    window.working_slot = levels.working_slot;
    std::copy(std::begin(levels.committed), std::end(levels.committed), window.stamps.begin());
    window.head = {view.object(), view.header().slots_offset};
    for (std::uint32_t k = 1; k < levels.n_slots; ++k)
      window.levels.emplace_back(view.slot(shm::slot_of(levels, static_cast<int>(k))), view.header().slot_bytes);
  }
  return checkpoint;
}

} // namespace mullion::run
