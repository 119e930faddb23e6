// Other code at work in a live run, between two steps: another carrier of a module (other parameters, another build,
// another plug-in) or the driver with other parameters. State lives in windows, so the candidate attaches to what is
// there and goes on; the one before it stays parked until the candidate's first step is committed. How one in a process
// attaches beside the moving run is in swap_beside.cpp.
//
// Who writes: of a module in a process, one carrier at a time has its windows mapped read-write; the candidate is
// parked while it attaches, the one before it afterwards. (Inline, both live in this process.) When a candidate dies,
// the parked one takes over; when the parked one dies, it is respawned like any other if it is needed.
#include "log/console.hpp"
#include "run/session.hpp"
#include "run/swap_fit.hpp"
#include "shm/levels.hpp"

#include <mullion/coupling/driver_plugin.hpp>
#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <utility>

namespace mullion::run {

using shm::Operation;

namespace {

/// All that a driver's define declared and that windows or calls were made from, as one text.
std::string connected(const Wiring& wiring)
{
  std::string text = fmt::format("{} {};", wiring.committed_state_levels, wiring.needs_constant_step);
  for (const auto& c : wiring.connections)
    text += fmt::format("{} < {} {} {};", c.receiver, c.source, static_cast<int>(c.policy), c.levels);
  for (const auto& s : wiring.states) text += fmt::format("{} {} {} {};", s.name, s.like, s.size, s.is_reported);
  for (const auto& s : wiring.squares) text += fmt::format("{} {} {};", s.name, fmt::join(s.like, " "), s.largest);
  for (const auto& h : wiring.histories) text += fmt::format("{} {};", h.window, h.committed_levels);
  for (const auto& c : wiring.clock_offsets) text += fmt::format("{} {};", c.instance, c.steps);
  return text;
}

} // namespace

void Session::require_fit(std::uint32_t m, const ModuleCase& candidate, const mullion_module& entries)
{
  const auto wrong = misfit(entries, m, windows_);
  MULLION_REQUIRE(wrong.empty(), Errc::plugin, "{} does not fit the windows of '{}': {}", candidate.plugin,
                  candidate.instance, wrong);
}

void Session::try_module(std::uint32_t m, ModuleCase candidate, const mullion_module& entries)
{
  MULLION_ASSERT(!has_trial() && !has_candidate() && n_in_flight_ == 0, "one trial at a time, between steps");
  require_fit(m, candidate, entries);
  Carrier carrier;
  carrier.entries = &entries;
  put_on_trial(m, std::move(candidate), std::move(carrier), [&](const TimeStep& at) {
    auto& module = modules_[m];
    module.function_windows = find_function_windows(module.config->instance, entries);
    spawn(m);
    call(m, Operation::create, at);
    if (module.host != nullptr) call(m, Operation::park, at);
    call(m, Operation::attach, at);
  });
}

void Session::put_on_trial(std::uint32_t m, ModuleCase config, Carrier candidate,
                           const std::function<void(const TimeStep& at)>& prepare)
{
  const auto at = now();
  auto& module = modules_[m];
  trial_.emplace();
  trial_->module = m;
  trial_->config = std::move(config);
  trial_->parked = std::exchange(static_cast<Carrier&>(module), std::move(candidate));
  module.config = &trial_->config;
  auto old_driver = std::move(driver_);
  is_running_ = false; // the start-up deadline holds
  try {
    arrange_timings(module);
    describe(m);
    prepare(at);
    module.is_attached = true;
    attach_driver(); // functions may have other numbers now, or not be there
    if (module.host != nullptr) hand_over(m, at);
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    restore_parked();
    trial_.reset();
    driver_ = std::move(old_driver);
    is_running_ = true;
    throw Error(Errc::plugin, reason);
  }
  is_running_ = true;
}

TimeStep Session::now() const
{
  const double time = control_.time;
  return {control_.step, time, time, case_.dt, 0};
}

void Session::hand_over(std::uint32_t m, const TimeStep& at)
{
  auto& at_work = static_cast<Carrier&>(modules_[m]);
  std::swap(at_work, trial_->parked);
  try {
    call(m, Operation::park, at);
  } catch (const Error& error) { // it is dead: then it writes nothing either
    log::debug("run", "while parking: {}", error.what());
  }
  std::swap(at_work, trial_->parked);
  call(m, Operation::resume, at);
}

void Session::restore_parked()
{
  auto& module = modules_[trial_->module];
  if (module.host != nullptr) supervisor_.kill(*module.host);
  static_cast<Carrier&>(module) = std::move(trial_->parked);
  module.is_attached = true;
  arrange_timings(module);
  describe(trial_->module);
  if (module.host == nullptr) return;
  show_host(trial_->module);
  try { // whether it was parked or not
    call(trial_->module, Operation::resume, now());
  } catch (const Error& error) { // dead meanwhile: the next step finds that out
    log::debug("run", "while taking back: {}", error.what());
  }
}

void Session::show_host(std::uint32_t m)
{
  if (modules_[m].host == nullptr) return;
  control_.modules[m].pid = modules_[m].host->pid;
  control_.modules[m].reply_fd = modules_[m].host->reply_object.get();
}

void Session::attach_driver()
{
  (void)make_driver();
  Coupling coupling(this);
  driver_->attach(coupling);
}

void Session::try_driver(std::vector<ParameterValue> parameters)
{
  MULLION_ASSERT(!has_trial() && n_in_flight_ == 0, "one trial at a time, between steps");
  trial_.emplace();
  trial_->driver_parameters = std::move(parameters);
  driver_parameters_ = &trial_->driver_parameters;
  auto old_driver = std::move(driver_);
  try {
    trial_->wiring = make_driver();
    MULLION_REQUIRE(connected(*trial_->wiring) == connected(*wiring_), Errc::plugin,
                    "driver {} would connect or keep other fields with these parameters; in a live run both stay as "
                    "they are",
                    case_.scheme);
    Coupling coupling(this);
    driver_->attach(coupling);
  } catch (const std::exception& error) {
    driver_ = std::move(old_driver);
    driver_parameters_ = &case_.driver_parameters;
    trial_.reset();
    throw Error(Errc::plugin, error.what());
  }
}

void Session::keep()
{
  if (trial_->module == shm::no_module) {
    driver_parameters_ = &case_.driver_parameters;
    wiring_ = std::move(trial_->wiring);
  } else {
    modules_[trial_->module].config = &case_.modules[trial_->module];
    if (trial_->parked.host != nullptr) supervisor_.kill(*trial_->parked.host); // it has nothing to lose
  }
  trial_.reset();
}

void Session::take_back()
{
  for (std::uint32_t m = 0; m < modules_.size(); ++m) {
    try {
      await(m);
    } catch (const Error& error) {
      log::debug("run", "while taking back: {}", error.what());
    }
  }
  if (trial_->module == shm::no_module) driver_parameters_ = &case_.driver_parameters;
  else restore_parked();
  trial_.reset();
  shm::roll_back(control_);
  attach_driver();
}

void Session::arrange_timings(Module& module)
{
  // What was counted under a name stays under it; functions that are no more stand behind those that are.
  const std::lock_guard lock(timings_mutex_);
  std::vector<std::string> calls{"step"};
  for (std::uint32_t f = 0; f < module.entries->n_functions; ++f) calls.emplace_back(module.entries->functions[f].name);
  for (const auto& timing : module.timings)
    if (timing.call != attach_call && std::find(calls.begin(), calls.end(), timing.call) == calls.end())
      calls.push_back(timing.call);
  calls.emplace_back(attach_call);
  std::vector<CallTiming> arranged;
  for (const auto& call : calls) {
    const auto known = std::find_if(module.timings.begin(), module.timings.end(),
                                    [&](const CallTiming& timing) { return timing.call == call; });
    arranged.push_back(known == module.timings.end() ? CallTiming{call} : *known);
  }
  module.timings = std::move(arranged);
}

std::vector<CallTiming> Session::timings_so_far(std::uint32_t module) const
{
  const std::lock_guard lock(timings_mutex_);
  return modules_[module].timings;
}

} // namespace mullion::run
