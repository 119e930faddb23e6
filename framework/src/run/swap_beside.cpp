// A candidate in a process attaches beside the moving run: it has the windows read-only and a process of its own, so
// the carrier at work goes on stepping, however long that takes. Sizes, meshes and fixed fields never change, so what
// it derives from them holds. What it saw of a level is of a commit that is long past when it is ready, or half of one
// and half of another: then it attaches once more at the exchange, and the run waits for that. The module's runtime
// knows which of the two it was.
//
// Who writes: the candidate nothing but its reply. It may die at any moment, and is given up then.
#include "log/console.hpp"
#include "process/supervisor.hpp"
#include "run/session.hpp"
#include "shm/wait.hpp"

#include <mullion/sdk/error.hpp>

#include <utility>

namespace mullion::run {

using shm::Operation;

Session::StandIn::StandIn(Session& session, std::uint32_t module, const ModuleCase& config,
                          const mullion_module& entries)
    : session_(session), module_(module),
      at_work_(std::exchange(static_cast<Carrier&>(session.modules_[module]), Carrier{}))
{
  session.modules_[module].config = &config;
  session.modules_[module].entries = &entries;
  session.is_running_ = false; // the start-up deadline holds
}

Session::StandIn::~StandIn()
{
  auto& module = session_.modules_[module_];
  if (module.host != nullptr) session_.supervisor_.kill(*module.host);
  static_cast<Carrier&>(module) = std::move(at_work_);
  module.is_attached = true;
  module.defined.clear();
  session_.describe(module_);
  session_.show_host(module_);
  session_.is_running_ = true;
}

void Session::begin_candidate(std::uint32_t m, ModuleCase config, const mullion_module& entries)
{
  MULLION_ASSERT(!has_trial() && !has_candidate() && n_in_flight_ == 0, "one trial at a time, between steps");
  MULLION_ASSERT(config.is_process, "an inline candidate cannot attach beside the run: '{}'", config.instance);
  require_fit(m, config, entries);
  candidate_.emplace();
  candidate_->module = m;
  candidate_->config = std::move(config);
  try {
    const StandIn stand_in(*this, m, candidate_->config, entries);
    auto& module = modules_[m];
    module.function_windows = find_function_windows(module.config->instance, entries);
    describe(m);
    spawn(m);
    call(m, Operation::create, now());
    attach_beside(m);
    candidate_->carrier = std::exchange(static_cast<Carrier&>(module), Carrier{});
  } catch (const std::exception& error) {
    const std::string reason = error.what();
    candidate_.reset();
    throw Error(Errc::plugin, reason);
  }
}

void Session::attach_beside(std::uint32_t m)
{
  // No call as the others are: its end is not awaited, and it is none of the run's calls in a post-mortem.
  auto& module = modules_[m];
  const auto& host = *module.host;
  auto& request = control_.modules[m].request;
  candidate_->number = request.word.load(std::memory_order_relaxed) + 1;
  candidate_->begun = Clock::now();
  candidate_->paused = supervisor_.paused();
  request.operation = Operation::attach_beside;
  request.incarnation = host.incarnation;
  shm::publish(request.word, candidate_->number, host.reply().asleep);
  const auto& word = host.reply().word;
  const auto is_taken = [&] {
    const auto found = word.load(std::memory_order_acquire);
    return found == candidate_->number || found == (candidate_->number ^ shm::attached_beside);
  };
  const auto is_over = [&] { return host.is_dead.load(std::memory_order_acquire) || is_candidate_late(); };
  if (shm::wait_for(word, control_.orchestrator_asleep, true, is_taken, is_over)) return;
  supervisor_.kill(*module.host); // where it is not dead, it is stopped
  module.operation = Operation::attach;
  fail(module, Errc::process, process::describe_end(host.wait_status));
}

bool Session::is_candidate_late() const
{
  if (!options_.has_deadlines || case_.start_deadline <= 0) return false;
  const auto waited = Clock::now() - candidate_->begun - (supervisor_.paused() - candidate_->paused);
  return waited > std::chrono::duration<double>(case_.start_deadline);
}

bool Session::is_candidate_due() const
{
  const auto& host = *candidate_->carrier.host;
  return host.reply().word.load(std::memory_order_acquire) == (candidate_->number ^ shm::attached_beside) ||
         host.is_dead.load(std::memory_order_acquire) || is_candidate_late();
}

void Session::exchange_candidate()
{
  const auto host = candidate_->carrier.host;
  const auto& config = candidate_->config;
  const auto refuse = [&](const std::string& why) {
    const auto text = fmt::format("module '{}' ({}, process {}) {}", config.instance, config.plugin, host->pid, why);
    drop_candidate();
    throw Error(Errc::plugin, text);
  };
  if (host->is_dead.load(std::memory_order_acquire)) {
    auto end = process::describe_end(host->wait_status);
    for (const auto& line : host->tail())
      if (line.rfind("a write into the read-only window", 0) == 0) end += " after " + line;
    refuse(fmt::format("{}, in attach, beside the run", end));
  }
  const auto& reply = host->reply();
  if (reply.word.load(std::memory_order_acquire) != (candidate_->number ^ shm::attached_beside))
    refuse(fmt::format("did not attach within its deadline of {} s and was killed; a longer one is run.start_deadline "
                       "in the case, none is --no-deadline",
                       case_.start_deadline));
  const bool saw_levels = reply.results[0] != 0.0;
  if (reply.status != MULLION_OK && !saw_levels)
    refuse(fmt::format("failed in attach, beside the run: {}", reply.error));

  auto candidate = std::move(*candidate_);
  candidate_.reset();
  const auto m = candidate.module;
  put_on_trial(m, std::move(candidate.config), std::move(candidate.carrier), [&](const TimeStep& at) {
    show_host(m);
    if (saw_levels) return call(m, Operation::attach, at);
    const auto work_ns = static_cast<std::int64_t>(reply.work_ns);
    auto& timing = modules_[m].timings.back();
    timing.count += 1;
    timing.wall_ns += work_ns;
    timing.work_ns += work_ns;
  });
}

void Session::drop_candidate()
{
  supervisor_.kill(*candidate_->carrier.host);
  candidate_.reset();
}

} // namespace mullion::run
