#include "module/module_runtime.hpp"

#include "shm/levels.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <array>
#include <set>

namespace mullion::module {

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
  has_attached_to_levels_ = false;
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
    if (phase_ == Phase::stepping && shm::is_checked_later(*at.field)) continue; // by the session, beside the run
    const auto* values = reinterpret_cast<const double*>(at.data);
    const auto bad = shm::first_not_finite(values, at.field->entities * at.field->components);
    if (bad < 0) continue;
    throw Error(Errc::numeric,
                shm::describe_not_finite(windows_.control().windows[window].name, *at.field, values, bad));
  }
}

} // namespace mullion::module
