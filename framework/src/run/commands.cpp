#include "run/commands.hpp"

#include "config/case_edit.hpp"
#include "config/case_reader.hpp"
#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_reader.hpp"
#include "log/console.hpp"
#include "plugin/catalogue.hpp"

#include <mullion/sdk/error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

namespace mullion::run {
namespace {

using Json = nlohmann::ordered_json;

std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

/// "a.b=v" as ("a.b", "v").
std::pair<std::string, std::string> split_assignment(const std::string& text)
{
  const auto equals = text.find('=');
  MULLION_REQUIRE(equals != std::string::npos && equals > 0, Errc::config, "'{}' has no '='; write {}=VALUE", text,
                  text);
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Assign one parameter among `parameters`.
/// @param label  whose they are: instance and plug-in
/// @return has it another value now, and is not declared changeable?
/// @throws Error Errc::config: unknown, no legal value, or not changeable though it must be
bool assign(std::vector<ParameterValue>& parameters, std::span<const mullion_parameter_spec> specs,
            const std::string& key, const std::string& value, const std::string& label, bool must_be_changeable)
{
  std::vector<std::string> names, changeable;
  const mullion_parameter_spec* spec = nullptr;
  for (const auto& s : specs) {
    names.emplace_back(s.name);
    if (s.is_changeable != 0) changeable.emplace_back(s.name);
    if (key == s.name) spec = &s;
  }
  MULLION_REQUIRE(spec != nullptr, Errc::config, "{} has no parameter '{}'{}", label, key,
                  config::suggestion(key, names));
  const auto parameter =
      std::find_if(parameters.begin(), parameters.end(), [&](const ParameterValue& p) { return p.name == key; });
  auto assigned = *parameter;
  const auto wrong = config::take_value(config::parse_value(value, {}), *spec, assigned);
  MULLION_REQUIRE(wrong.empty(), Errc::config, "{} {} {}", label, key, wrong);
  const bool is_bold = spec->is_changeable == 0 && assigned.value != parameter->value;
  MULLION_REQUIRE(!must_be_changeable || !is_bold, Errc::config,
                  "{} does not declare '{}' as changeable: it may shape windows or first states, which a live run "
                  "keeps; {}",
                  label, key,
                  changeable.empty() ? "none of its parameters is"
                                     : fmt::format("changeable are {}", fmt::join(changeable, ", ")));
  *parameter = assigned;
  return is_bold;
}

} // namespace

std::string reply_done(const std::string& what, std::int64_t step) { return text_of({{"ok", what}, {"step", step}}); }

std::string reply_refused(Errc code, const std::string& why)
{
  return text_of({{"error", why}, {"code", static_cast<int>(code)}});
}

// ---- the supervisor's thread -------------------------------------------------------------------------------------

void Commands::answer(const std::string& line, const process::Reply& reply)
{
  const auto blank = line.find(' ');
  const auto what = line.substr(0, blank);
  const auto arguments = blank == std::string::npos ? "{}" : line.substr(blank + 1);
  if (what == "status") return reply(status());
  if (what == "timings") return reply(timings());
  if (what == "stop") {
    supervisor_.request_stop("mullion stop");
    return reply(reply_done("stops", session_.control().step.load()));
  }
  const std::vector<std::string> known{"status", "timings", "stop", "swap", "set", "checkpoint"};
  if (std::find(known.begin(), known.end(), what) == known.end())
    return reply(reply_refused(Errc::config,
                               fmt::format("a run knows no command '{}'{}", what, config::suggestion(what, known))));
  const std::lock_guard lock(mutex_);
  if (is_over_) return reply(reply_refused(Errc::process, "the run is at its end"));
  pending_.push_back({what, arguments, reply});
  has_pending_.store(true, std::memory_order_relaxed);
}

std::string Commands::status() const
{
  const auto& control = session_.control();
  return text_of({{"name", control.run_name},
                  {"pid", control.guard_pid},
                  {"step", control.step.load()},
                  {"steps", control.n_steps.load()},
                  {"time", control.time.load()},
                  {"orchestrator", control.orchestrator_pid},
                  {"control", supervisor_.control_fd()}});
}

std::string Commands::timings() const
{
  Json modules = Json::array();
  if (session_.control().state.load() == shm::RunState::running)
    for (std::uint32_t m = 0; m < case_.modules.size(); ++m) {
      Json calls = Json::array();
      for (const auto& timing : session_.timings_so_far(m))
        calls.push_back({{"call", timing.call},
                         {"count", std::int64_t{timing.count}},
                         {"wall_s", 1e-9 * static_cast<double>(timing.wall_ns)},
                         {"work_s", 1e-9 * static_cast<double>(timing.work_ns)}});
      modules.push_back(std::move(calls));
    }
  return text_of({{"timings", modules}});
}

// ---- the main thread ---------------------------------------------------------------------------------------------

void Commands::apply_pending(StepClock& clock)
{
  while (!session_.has_trial()) {
    Pending command;
    {
      const std::lock_guard lock(mutex_);
      if (pending_.empty()) {
        has_pending_.store(false, std::memory_order_relaxed);
        return;
      }
      // One change at a time: while a candidate attaches, the next one waits. A checkpoint changes nothing and may
      // overtake those that wait.
      const auto next =
          !session_.has_candidate()
              ? pending_.begin()
              : std::find_if(pending_.begin(), pending_.end(), [](const Pending& p) { return p.what == "checkpoint"; });
      if (next == pending_.end()) return;
      command = std::move(*next);
      pending_.erase(next);
    }
    try {
      apply(command, clock);
    } catch (const Error& error) {
      log::warning("run", "{} refused: {}", command.what, error.what());
      command.reply(reply_refused(error.code(), error.what()));
    } catch (const std::exception& error) { // JSON that is none
      command.reply(reply_refused(Errc::config, error.what()));
    }
  }
}

void Commands::exchange_candidate()
{
  try {
    session_.exchange_candidate();
  } catch (const Error& error) {
    log::warning("run", "{} refused: {}", on_trial_.what, error.what());
    std::exchange(on_trial_, {}).reply(reply_refused(error.code(), error.what()));
  }
}

void Commands::apply(const Pending& command, StepClock& clock)
{
  if (command.what == "swap") return apply_swap(command);
  if (command.what == "set") return apply_set(command, clock);
  recorder_.write_checkpoint([reply = command.reply](std::int64_t step, const std::string& problem) {
    reply(problem.empty() ? reply_done(fmt::format("checkpoint of step {}", step), step)
                          : reply_refused(Errc::io, problem));
  });
}

std::uint32_t Commands::find_target(const std::string& name) const
{
  std::vector<std::string> known;
  for (std::uint32_t m = 0; m < case_.modules.size(); ++m) {
    const auto& module = case_.modules[m];
    if (name == module.instance || name == module.kind) return m;
    known.push_back(module.instance);
  }
  throw Error(Errc::config, fmt::format("the run has no module '{}'{}", name, config::suggestion(name, known)));
}

void Commands::apply_swap(const Pending& command)
{
  const auto arguments = Json::parse(command.arguments);
  MULLION_REQUIRE(arguments.at("target") != "driver", Errc::config,
                  "a driver cannot be swapped: what {} connects and keeps is made for the whole run; 'mullion set' "
                  "changes its parameters (driver.NAME=VALUE), another scheme is another run",
                  case_.scheme);
  const auto m = find_target(arguments.at("target"));
  const std::string wanted = arguments.at("module");
  const auto& now = case_.modules[m];

  std::string file = wanted;
  if (wanted.find('/') == std::string::npos) {
    const plugin::Catalogue catalogue;
    file = catalogue.find(wanted);
    MULLION_REQUIRE(!file.empty(), Errc::plugin, "there is no plug-in '{}'{} (searched {})", wanted,
                    config::suggestion(wanted, catalogue.names()), fmt::join(catalogue.folders(), ", "));
  }
  const auto& library = copies_.open(file);
  MULLION_REQUIRE(library.header().kind == now.kind, Errc::plugin, "{} is a {}, '{}' is a {}", library.header().name,
                  library.header().kind, now.instance, now.kind);

  // The same plug-in goes on with the parameters as they stand, another one starts from its own defaults.
  ModuleCase candidate{now.instance,   now.kind, library.header().name, library.header().version, library.path(),
                       now.is_process, {}};
  const auto label = fmt::format("'{}' ({})", candidate.instance, candidate.plugin);
  const bool is_same = candidate.plugin == now.plugin;
  for (const auto& spec : library.parameters()) {
    auto& parameter = candidate.parameters.emplace_back(config::default_value(spec));
    const auto known = std::find_if(now.parameters.begin(), now.parameters.end(), [&](const ParameterValue& p) {
      return p.name == spec.name && p.value.index() == parameter.value.index();
    });
    const bool is_kept = is_same || spec.name == config::reference_pressure;
    if (is_kept && known != now.parameters.end()) parameter = *known;
  }
  std::string changes;
  std::vector<std::string> bold;
  for (const std::string text : arguments.at("sets")) {
    auto [key, value] = split_assignment(text);
    if (key.starts_with(now.instance + ".")) key.erase(0, now.instance.size() + 1);
    if (assign(candidate.parameters, library.parameters(), key, value, label, false))
      bold.push_back(fmt::format("{} = {}", key, value));
    changes += fmt::format(", {} = {}", key, value);
  }
  for (std::size_t p = 0; p < candidate.parameters.size(); ++p)
    MULLION_REQUIRE(library.parameters()[p].is_required == 0 || candidate.parameters[p].is_given, Errc::config,
                    "{} needs the parameter '{}': {}; give it with --set", label, candidate.parameters[p].name,
                    library.parameters()[p].meaning);

  on_trial_ = {"swap",
               now.instance,
               fmt::format("{} {} for {} {}, from {}{}", candidate.plugin, candidate.version, now.plugin, now.version,
                           file, changes),
               candidate,
               {},
               command.reply};
  if (is_same && !bold.empty()) // another plug-in made no first state in this run
    session_.require_same_definition(m, candidate, library.module(), fmt::format("{}", fmt::join(bold, ", ")));
  if (candidate.is_process) session_.begin_candidate(m, std::move(candidate), library.module());
  else session_.try_module(m, std::move(candidate), library.module());
}

void Commands::apply_set(const Pending& command, StepClock& clock)
{
  const std::vector<std::string> sets = Json::parse(command.arguments).at("sets");
  MULLION_REQUIRE(!sets.empty(), Errc::config, "nothing to set");
  std::string table, changes;
  std::vector<std::pair<std::string, std::string>> assignments;
  for (const auto& text : sets) {
    const auto [path, value] = split_assignment(text);
    const auto dot = path.find('.');
    MULLION_REQUIRE(dot != std::string::npos, Errc::config, "'{}' names no table; write instance.parameter=VALUE",
                    text);
    MULLION_REQUIRE(table.empty() || table == path.substr(0, dot), Errc::config,
                    "one table at a time: '{}' and '{}' are two; give two commands", table, path.substr(0, dot));
    table = path.substr(0, dot);
    assignments.emplace_back(path.substr(dot + 1), value);
    changes += fmt::format("{}{} = {}", changes.empty() ? "" : ", ", assignments.back().first, value);
  }
  if (table == "run" || table == "output") {
    MULLION_REQUIRE(assignments.size() == 1, Errc::config, "one key of [{}] at a time", table);
    set_run(table + "." + assignments[0].first, assignments[0].second, clock);
    recorder_.note(session_.control().step, "set", table, changes);
    log::info("run", "set {}: {}", table, changes);
    return command.reply(reply_done(fmt::format("{}: {}", table, changes), session_.control().step.load()));
  }
  on_trial_ = {"set", table, changes, {}, {}, command.reply};
  if (table == "driver") {
    const plugin::Library library(case_.scheme_path);
    on_trial_.driver_parameters = case_.driver_parameters;
    for (const auto& [key, value] : assignments)
      assign(on_trial_.driver_parameters, library.parameters(), key, value, "driver " + case_.scheme, true);
    return session_.try_driver(on_trial_.driver_parameters);
  }
  const auto m = find_target(table);
  auto candidate = case_.modules[m];
  const plugin::Library library(candidate.path); // the code at work: the loader knows it by its path
  for (const auto& [key, value] : assignments)
    assign(candidate.parameters, library.parameters(), key, value,
           fmt::format("'{}' ({})", candidate.instance, candidate.plugin), true);
  on_trial_.instance = candidate.instance;
  on_trial_.module = candidate;
  session_.try_module(m, std::move(candidate), library.module());
}

void Commands::set_run(const std::string& key, const std::string& value, StepClock& clock)
{
  const auto node = config::parse_value(value, {});
  const auto* real = std::get_if<double>(&node.value);
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  if (key == "run.end_time") {
    MULLION_REQUIRE(real != nullptr || integer != nullptr, Errc::config, "{} = {}: expected a time [s]", key, value);
    auto changed = case_;
    changed.end_time = real != nullptr ? *real : static_cast<double>(*integer);
    const auto& control = session_.control();
    const double now = control.step == 0 ? case_.start_time : control.time.load();
    MULLION_REQUIRE(std::isfinite(changed.end_time) && changed.end_time > now, Errc::config,
                    "{} = {} s is not behind the run, which is at t = {} s; 'mullion stop' ends it here", key, value,
                    now);
    clock = StepClock(changed, session_.wiring().needs_constant_step, clock.state());
    case_.end_time = changed.end_time;
    case_.text = config::edit_key(case_.text, "run", {"end_time", changed.end_time, true});
    session_.control().n_steps = clock.n_steps();
  } else if (key == "output.every") {
    MULLION_REQUIRE(integer != nullptr && *integer >= 1, Errc::config, "{} = {}: expected a number of steps >= 1", key,
                    value);
    MULLION_REQUIRE(case_.output_every > 0, Errc::config,
                    "{}: the run was started without result files (output.every = 0), and gets none later", key);
    case_.output_every = *integer;
    case_.text = config::edit_key(case_.text, "output", {"every", *integer, true});
  } else {
    throw Error(Errc::config, fmt::format("{} cannot be changed in a live run; of the run itself run.end_time and "
                                          "output.every can",
                                          key));
  }
}

void Commands::keep(const TimeStep& step)
{
  auto& [what, instance, detail, module, driver_parameters, reply] = on_trial_;
  if (instance == "driver") {
    case_.driver_parameters = driver_parameters;
    case_.text = config::edit_plugin(case_.text, "driver", "scheme", case_.scheme, driver_parameters);
  } else {
    case_.modules[find_target(instance)] = module;
    case_.text = config::edit_plugin(case_.text, instance, "module", module.plugin, module.parameters);
  }
  session_.keep();
  recorder_.note(step.index, what, instance, detail);
  log::info("run", "{} {}: {}; at work from step {} on", what, instance, detail, step.index);
  reply(reply_done(fmt::format("{}: {}", instance, detail), step.index));
  on_trial_ = {};
}

bool Commands::take_back(const TimeStep& step, const std::string& failure)
{
  if (!session_.has_trial()) return false;
  const auto [what, instance, detail, module, driver_parameters, reply] = std::exchange(on_trial_, {});
  session_.take_back();
  const auto text = fmt::format("{} {} ({}) taken back, the one before it does step {} again: {}", what, instance,
                                detail, step.index, failure);
  recorder_.note(step.index, what + " taken back", instance, fmt::format("{}: {}", detail, failure));
  log::warning("run", "{}", text);
  reply(reply_refused(Errc::process, text));
  return true;
}

void Commands::finish()
{
  if (session_.has_candidate()) {
    session_.drop_candidate();
    on_trial_.reply(reply_refused(Errc::process, "the run ended before the candidate had attached"));
  } else if (session_.has_trial()) {
    on_trial_.reply(reply_refused(Errc::process, "the run failed before the outcome was known"));
  }
  const std::lock_guard lock(mutex_);
  is_over_ = true;
  for (const auto& command : std::exchange(pending_, {}))
    command.reply(reply_refused(Errc::process, "the run ended before it came to that"));
}

} // namespace mullion::run
