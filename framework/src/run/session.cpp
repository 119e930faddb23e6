#include "run/session.hpp"

#include "log/console.hpp"
#include "shm/levels.hpp"
#include "shm/wait.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>

namespace mullion::run {

using shm::Operation;

// ---- calls -----------------------------------------------------------------------------------------------------

const std::vector<std::uint32_t>& Session::windows_written(const Module& module) const
{
  static const std::vector<std::uint32_t> none;
  if (module.operation == Operation::step || module.operation == Operation::start) return module.windows;
  return module.operation == Operation::call ? module.function_windows[module.function] : none;
}

void Session::refuse_conflicts(std::uint32_t module) const
{
  for (std::uint32_t other = 0; other < modules_.size(); ++other)
    MULLION_REQUIRE(!modules_[other].in_flight || (modules_[module].conflicts >> other & 1u) == 0, Errc::config,
                    "driver {}: a call of '{}' was started while '{}' is at work, but one reads the other's window in "
                    "place (a bound field); await the first, or store the field instead",
                    case_.scheme, modules_[module].config->instance, modules_[other].config->instance);
}

void Session::begin(std::uint32_t index, Operation operation, std::uint32_t function, const TimeStep& step,
                    double stamp, const double* arguments, std::uint32_t n_arguments)
{
  auto& module = modules_[index];
  MULLION_REQUIRE(!module.in_flight, Errc::config, "driver {}: module '{}' was called again before it was awaited",
                  case_.scheme, module.config->instance);
  if (n_in_flight_ > 0 && is_running_) refuse_conflicts(index); // start-up calls read no other window
  module.operation = operation;
  module.function = function;
  module.step = step;
  module.stamp = stamp;
  if (operation == Operation::define || operation == Operation::start) { // its own clock, from the beginning
    module.step.begin = module.step.end = step.end + module.clock_offset;
    module.stamp = stamp + module.clock_offset;
  }
  if (!checks_.empty()) settle_before_writing(index);
  const bool is_step = operation == Operation::step;

  auto& request = control_.modules[index].request;
  request.operation = operation;
  request.function = function;
  request.epoch = control_.epoch.load(std::memory_order_relaxed);
  request.step = {step.index, module.step.begin, module.step.end, step.dt, step.iteration, 0};
  request.flags = is_step ? static_cast<std::uint32_t>(shm::arm_state) : 0u;
  for (std::uint32_t i = 0; i < n_arguments; ++i) request.arguments[i] = arguments[i];
  for (const auto w : windows_written(module)) {
    control_.working[w].is_written = 0;
    if (!options_.is_audited || !is_running_) continue;
    request.flags |= shm::check_written;
    if (module.poisoned.insert(w).second || is_step) request.flags |= shm::poison;
  }
  control_.current = {index, operation, function, 0, step.index, step.begin};
  module.in_flight = true;
  module.paused = supervisor_.paused(); // in this order: a pause in between makes us too patient, not too strict
  module.begun = Clock::now();
  ++n_in_flight_;

  if (module.runtime == nullptr) {
    request.incarnation = module.host->incarnation;
    shm::publish(request.word, request.word.load(std::memory_order_relaxed) + 1, module.host->reply().asleep);
    return;
  }
  // Inline: the call happens here; its outcome is told by await, as for a host.
  module.inline_error = nullptr;
  try {
    switch (operation) {
    case Operation::create: module.runtime->create(); break;
    case Operation::define: module.defined = module.runtime->define(request.step); break;
    case Operation::attach: module.runtime->attach(); break;
    case Operation::start: module.runtime->start(request.step); break;
    case Operation::seal: module.runtime->seal(); break;
    default: module.runtime->run(request, &module.result);
    }
  } catch (...) {
    module.inline_error = std::current_exception();
  }
  module.inline_work_ns = nanoseconds_since(module.begun);
}

void Session::await(std::uint32_t index)
{
  auto& module = modules_[index];
  if (!module.in_flight) return;
  std::int64_t work_ns = module.inline_work_ns;
  struct Landing { // whatever happens, the call is over
    Session& session;
    Module& module;
    ~Landing()
    {
      module.in_flight = false;
      --session.n_in_flight_;
      session.control_.current.module = shm::no_module;
    }
  } landing{*this, module};
  if (module.runtime == nullptr) {
    await_host(module);
    const auto& reply = module.host->reply();
    work_ns = static_cast<std::int64_t>(reply.work_ns);
    if (reply.status != MULLION_OK) fail(module, static_cast<Errc>(reply.status), reply.error);
    module.result = reply.results[0];
  } else if (module.inline_error != nullptr) {
    try {
      std::rethrow_exception(module.inline_error);
    } catch (const Error& error) {
      fail(module, error.code(), error.what());
    } catch (const std::exception& error) {
      fail(module, Errc::internal, error.what());
    }
  }
  for (const auto w : windows_written(module))
    mark_written(w, {module.stamp, module.step.index, module.step.iteration, MULLION_INSTANT});
  if (!module.large_fields.empty()) check_later(index);
  const bool is_attach = module.operation == Operation::attach;
  if (module.operation != Operation::step && module.operation != Operation::call && !is_attach) return;
  auto& timing =
      is_attach ? module.timings.back() : module.timings[module.operation == Operation::step ? 0 : 1 + module.function];
  timing.count += 1;
  timing.wall_ns += nanoseconds_since(module.begun);
  timing.work_ns += work_ns;
}

void Session::await_host(Module& module)
{
  auto& host = *module.host;
  const auto& request = control_.modules[host.module].request;
  const auto number = request.word.load(std::memory_order_relaxed);
  const auto& word = host.reply().word;
  const double deadline = is_running_ ? case_.call_deadline : case_.start_deadline;
  const bool has_deadline = options_.has_deadlines && deadline > 0;
  bool is_late = false;
  const auto is_done = [&] { return word.load(std::memory_order_acquire) == number; };
  const auto is_over = [&] {
    if (host.is_dead.load(std::memory_order_acquire)) return true;
    if (!has_deadline) return false;
    const auto waited = Clock::now() - module.begun - (supervisor_.paused() - module.paused);
    is_late = waited > std::chrono::duration<double>(deadline);
    return is_late;
  };
  const bool may_spin = n_in_flight_ == 1; // else the cores belong to the solvers
  if (shm::wait_for(word, control_.orchestrator_asleep, may_spin, is_done, is_over)) return;
  if (is_late && !host.is_dead) {
    supervisor_.kill(host);
    fail_by_end(module, fmt::format("did not answer within its deadline of {} s (stopped, or in an endless loop?) and "
                                    "was killed; a longer one is run.{} in the case, none is --no-deadline",
                                    deadline, is_running_ ? "call_deadline" : "start_deadline"));
  }
  std::string text = process::describe_end(host.wait_status);
  for (const auto& line : host.tail())
    if (line.rfind("a write into the read-only window", 0) == 0) text += " after " + line;
  fail_by_end(module, text);
}

std::string Session::who(const Module& module) const
{
  const auto& config = *module.config;
  if (module.host == nullptr) return fmt::format("module '{}' ({}, inline)", config.instance, config.plugin);
  return fmt::format("module '{}' ({}, process {})", config.instance, config.plugin, module.host->pid);
}

const char* Session::call_name(const Module& module)
{
  return module.operation == Operation::call ? module.entries->functions[module.function].name
                                             : shm::to_string(module.operation);
}

std::string Session::where(const Module& module) const
{
  const auto* call = call_name(module);
  if (!is_running_ && control_.step == 0) return fmt::format("in {}, before the first step", call);
  if (!is_running_) return fmt::format("in {}, after step {}", call, control_.step.load());
  return fmt::format("in {}, step {}, t = {} s", call, module.step.index, module.step.begin);
}

void Session::fail(const Module& module, Errc code, const std::string& what) const
{
  throw Error(code, fmt::format("{} failed {}: {}", who(module), where(module), what));
}

void Session::fail_by_end(const Module& module, const std::string& how)
{
  last_death_ = fmt::format("'{}' {}, in {}", module.config->instance, how, call_name(module));
  throw Error(Errc::process, fmt::format("{} {}, {}", who(module), how, where(module)));
}

std::string Session::post_mortem() const
{
  std::string text;
  for (const auto& module : modules_) {
    if (module.host == nullptr || !module.host->is_dead) continue;
    text += fmt::format("{} {}, {}; its last lines:\n", who(module), process::describe_end(module.host->wait_status),
                        where(module));
    for (const auto& line : module.host->tail()) text += "  " + line + "\n";
  }
  return text;
}

// ---- steps -----------------------------------------------------------------------------------------------------

void Session::begin_attempt()
{
  if (!checks_.empty()) forget_checks();
  shm::roll_back(control_);
  write_order_.clear();
  for (auto& module : modules_) module.poisoned.clear();
  const auto& table = control_.table(control_.epoch.load(std::memory_order_relaxed));
  for (std::uint32_t w = 0; w < control_.n_windows; ++w) {
    if (control_.windows[w].owner != shm::Owner::orchestrator) continue;
    if (options_.is_audited) shm::poison_working(windows_.view(w), table.windows[w]);
    if (w == state_window_) shm::arm(windows_.view(w), table.windows[w]);
  }
}

void Session::run_driver(const TimeStep& step)
{
  run_and_settle([&] { driver_->step(step); });
  if (ledger_) count(*this, *ledger_, step);
  if (state_window_ != shm::no_window) mark_written(state_window_, {step.end, step.index, 0, MULLION_INSTANT});
}

void Session::check_limits(const TimeStep& step)
{
  if (case_.displacement_limit <= 0.0) return;
  const auto& port = case_.interfaces[0].structure;
  const auto& view = windows_.view(find_field(port + ".displacement", false, 0).window);
  for (std::uint32_t pane = 0; pane < view.header().n_panes; ++pane) {
    const auto values = read(find_field(port + ".displacement", false, pane), 0);
    Eigen::Index component = 0, node = 0;
    const double largest = values.cwiseAbs().maxCoeff(&component, &node);
    MULLION_REQUIRE(
        largest <= case_.displacement_limit, Errc::numeric,
        "the run diverges: in step {}, t = {} s, {}.displacement[{}, {}] = {} m (component, node) is beyond "
        "coupling.displacement_limit = {} m",
        step.index, step.end, port, component, node, values(component, node), case_.displacement_limit);
  }
}

void Session::mark_written(std::uint32_t window, const mullion_stamp& stamp)
{
  control_.working[window] = {stamp, 1, 0};
  if (std::find(write_order_.begin(), write_order_.end(), window) == write_order_.end()) write_order_.push_back(window);
}

void Session::commit(const TimeStep& step)
{
  MULLION_ASSERT(n_settled_ == checks_.size(), "{} of {} checks are settled", n_settled_, checks_.size());
  shm::commit(control_);
  control_.step = step.index;
  control_.time = step.end;
}

void Session::shut_down()
{
  for (auto& module : modules_) {
    if (module.host == nullptr || module.host->is_dead || module.in_flight) continue;
    auto& request = control_.modules[module.host->module].request;
    request.operation = Operation::quit;
    request.incarnation = module.host->incarnation;
    shm::publish(request.word, request.word.load() + 1, module.host->reply().asleep);
  }
  for (auto& module : modules_)
    if (module.host != nullptr) supervisor_.join(*module.host, std::chrono::milliseconds(module.in_flight ? 0 : 2000));
}

// ---- fields ----------------------------------------------------------------------------------------------------

std::uint32_t Session::find_module(const std::string& instance) const
{
  for (std::uint32_t m = 0; m < modules_.size(); ++m)
    if (modules_[m].config->instance == instance) return m;
  throw Error(Errc::config, fmt::format("driver {}: the case has no module '{}'", case_.scheme, instance));
}

std::uint32_t Session::find_function(std::uint32_t module, const std::string& name, std::uint32_t n_arguments,
                                     std::uint32_t n_results) const
{
  const auto& entries = *modules_[module].entries;
  for (std::uint32_t f = 0; f < entries.n_functions; ++f) {
    const auto& spec = entries.functions[f];
    if (name != spec.name) continue;
    MULLION_REQUIRE(
        spec.n_arguments == n_arguments && spec.n_results == n_results, Errc::config,
        "driver {}: function '{}' of module '{}' takes {} numbers and answers {}; the driver expects {} and {}",
        case_.scheme, name, modules_[module].config->instance, spec.n_arguments, spec.n_results, n_arguments,
        n_results);
    return f;
  }
  throw Error(Errc::config, fmt::format("driver {}: module '{}' ({}) offers no function '{}'", case_.scheme,
                                        modules_[module].config->instance, modules_[module].config->plugin, name));
}

FieldAddress Session::find_field(const std::string& port, bool is_received, std::uint32_t pane)
{
  const auto first = port.find('.'), second = port.find('.', first + 1);
  MULLION_REQUIRE(second != std::string::npos, Errc::config, "driver {}: '{}' is no port; write instance.window.field",
                  case_.scheme, port);
  const auto window = fmt::format("{}/{}{}", port.substr(0, first), port.substr(first + 1, second - first - 1),
                                  is_received ? ".in" : "");
  const auto id = control_.find_window(window);
  MULLION_REQUIRE(id != shm::no_window, Errc::config, "driver {}: there is no window {} for the port '{}'",
                  case_.scheme, window, port);
  const int field = windows_.view(id).find_field(pane, port.substr(second + 1));
  MULLION_REQUIRE(field >= 0, Errc::config, "driver {}: window {} has no field '{}' on pane {}", case_.scheme, window,
                  port.substr(second + 1), pane);
  return {id, static_cast<std::uint32_t>(field)};
}

FieldAddress Session::find_state(const std::string& name)
{
  const int field = state_window_ == shm::no_window ? -1 : windows_.view(state_window_).find_field(0, name);
  MULLION_REQUIRE(field >= 0, Errc::config, "driver {}: its define declared no state '{}'", case_.scheme, name);
  return {state_window_, static_cast<std::uint32_t>(field)};
}

Pane Session::pane_of(const std::string& window, std::uint32_t pane)
{
  auto name = window;
  if (const auto dot = name.find('.'); dot != std::string::npos) name[dot] = '/';
  const auto id = control_.find_window(name);
  MULLION_REQUIRE(id != shm::no_window && pane < windows_.view(id).header().n_panes, Errc::config,
                  "driver {}: there is no pane {} of a window {}", case_.scheme, pane, window);
  std::vector<mullion_block> blocks;
  return to_pane(windows_.view(id).pane(pane, blocks));
}

ConstArray Session::read(FieldAddress at, int level)
{
  const auto found = windows_.locate(at.window, at.field, level, control_.epoch.load(std::memory_order_relaxed));
  return {reinterpret_cast<const double*>(found.data), found.field->components, found.field->entities};
}

Array Session::write(FieldAddress at)
{
  MULLION_ASSERT(control_.windows[at.window].owner == shm::Owner::orchestrator, "a driver writes its own windows only");
  const auto found = windows_.locate(at.window, at.field, 0, control_.epoch.load(std::memory_order_relaxed));
  return {reinterpret_cast<double*>(found.data), found.field->components, found.field->entities};
}

void Session::stamp(FieldAddress at, double time, std::uint32_t kind)
{
  const auto values = read(at, 0);
  const auto bad = shm::first_not_finite(values.data(), values.size());
  MULLION_REQUIRE(bad < 0, Errc::numeric, "driver {}: wrote {} into {}.{}[{}, {}] for t = {} s: not a finite number",
                  case_.scheme, values.data()[bad], control_.windows[at.window].name,
                  windows_.view(at.window).fields()[at.field].name, bad % values.rows(), bad / values.rows(), time);
  mark_written(at.window, {time, control_.step + 1, 0, static_cast<std::int32_t>(kind)});
}

void Session::warn(const std::string& text) const { log::warning("driver", "{}: {}", case_.scheme, text); }

std::optional<double> Session::ask(const std::string& instance, const std::string& function,
                                   std::span<const double> arguments)
{
  const auto m = find_module(instance);
  const auto& entries = *modules_[m].entries;
  for (std::uint32_t f = 0; f < entries.n_functions; ++f) {
    const auto& spec = entries.functions[f];
    if (function != spec.name || spec.n_arguments != arguments.size() || spec.n_results != 1) continue;
    const double now = control_.time.load();
    begin(m, Operation::call, f, {control_.step.load(), now, now, case_.dt, 0}, now, arguments.data(),
          static_cast<std::uint32_t>(arguments.size()));
    await(m);
    return result(m);
  }
  return std::nullopt;
}

void Session::exchange(FieldAddress at)
{
  const auto owner = control_.windows[at.window];
  if (owner.owner != shm::Owner::module) return;
  auto& record = control_.modules[owner.module];
  for (std::uint32_t i = 0; i < record.n_exchanged; ++i)
    if (record.exchanged[i].window == at.window && record.exchanged[i].field == at.field) return;
  MULLION_REQUIRE(record.n_exchanged < shm::max_exchanged, Errc::config,
                  "more than {} fields of module '{}' are read by others", shm::max_exchanged, record.name);
  record.exchanged[record.n_exchanged++] = {at.window, at.field};
  if (shm::is_checked_later(windows_.view(at.window).fields()[at.field]))
    modules_[owner.module].large_fields.push_back(at);
}

} // namespace mullion::run
