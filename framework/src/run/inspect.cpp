// An onlooker in a process of its own: it asks the run where its control object is, maps that and the windows
// read-only, and reads committed levels. Nobody waits for it and it holds nothing, so it cannot disturb a run by dying,
// stopping or being slow. What it copied is valid if the slot it came from is still a committed one afterwards; else it
// tries again, from the beginning of the next step.
#include <mullion/app/inspect.hpp>

#include "config/suggestions.hpp"
#include "process/ask.hpp"
#include "shm/window_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <thread>

namespace mullion {
namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

constexpr std::chrono::seconds patience_with_steps{2};

template <std::size_t N> std::string word(const char* const (&words)[N], std::uint32_t value)
{
  return value < N ? words[value] : "unknown";
}
constexpr const char* locations[] = {"node", "element", "pane"};
constexpr const char* roles[] = {"state", "output", "fixed"};
constexpr const char* natures[] = {"intensive", "extensive"};

class Onlooker {
public:
  explicit Onlooker(const std::string& run) : run_(run), status_(process::ask(run, "status"))
  {
    mapping_ = shm::map_object(status_.at("orchestrator"), status_.at("control"), shm::Access::read_only);
    control_ = &shm::checked_control(mapping_.data, mapping_.bytes);
    MULLION_REQUIRE(control_->state.load() == shm::RunState::running, Errc::process,
                    "run '{}' is {}; its windows can be looked at while it steps", run,
                    control_->state.load() == shm::RunState::starting ? "still starting" : "at its end");
    windows_ = std::make_unique<shm::WindowMap>(*control_, false);
  }

  [[nodiscard]] const shm::Control& control() const { return *control_; }
  [[nodiscard]] const shm::WindowView& view(std::uint32_t window) { return windows_->view(window); }

  /// The bytes of these fields of a window at level -1, all of one commit, and that level's stamp.
  struct Copy {
    std::vector<std::vector<std::byte>> fields;
    mullion_stamp stamp{};
  };
  Copy copy(std::uint32_t window, const std::vector<std::uint32_t>& fields)
  {
    const auto end = Clock::now() + patience_with_steps;
    Copy out;
    out.fields.resize(fields.size());
    for (;;) {
      const auto epoch = control_->epoch.load(std::memory_order_acquire);
      out.stamp = control_->table(epoch).windows[window].committed[0];
      std::set<std::uint32_t> sources;
      for (std::size_t i = 0; i < fields.size(); ++i) {
        const auto at = windows_->locate(window, fields[i], 1, epoch);
        const auto n = static_cast<std::size_t>(shm::field_bytes(*at.field));
        out.fields[i].resize(n);
        if (n > 0) std::memcpy(out.fields[i].data(), at.data, n);
        sources.insert(source_of(window, fields[i]));
      }
      std::atomic_thread_fence(std::memory_order_acquire);
      if (std::all_of(sources.begin(), sources.end(), [&](std::uint32_t w) { return is_unchanged(w, epoch); }))
        return out;
      MULLION_REQUIRE(Clock::now() < end, Errc::process,
                      "run '{}' steps faster than {} can be copied; look at one field of it", run_,
                      control_->windows[window].name);
      const auto seen = control_->epoch.load();
      while (control_->epoch.load() == seen && Clock::now() < end) std::this_thread::yield();
    }
  }

private:
  [[nodiscard]] std::uint32_t source_of(std::uint32_t window, std::uint32_t field)
  {
    const auto& record = windows_->view(window).fields()[field];
    return static_cast<shm::Storage>(record.storage) == shm::Storage::bound ? record.source_window : window;
  }

  /// Is what was level -1 at that epoch still a committed level? (A window that no step writes keeps its slots.)
  [[nodiscard]] bool is_unchanged(std::uint32_t window, std::uint64_t epoch) const
  {
    const auto slot = shm::slot_of(control_->table(epoch).windows[window], 1);
    const auto now = control_->epoch.load(std::memory_order_acquire);
    if (now == epoch) return true;
    if (now != epoch + 1) return false; // the older table may be in the making
    const bool is_committed = slot != control_->table(now).windows[window].working_slot;
    std::atomic_thread_fence(std::memory_order_acquire);
    return is_committed && control_->epoch.load(std::memory_order_acquire) == now;
  }

  std::string run_;
  nlohmann::json status_;
  shm::Mapping mapping_;
  const shm::Control* control_ = nullptr;
  std::unique_ptr<shm::WindowMap> windows_;
};

std::string name_of(const shm::Control& control, std::uint32_t module)
{
  return module < control.n_modules ? control.modules[module].name : "driver";
}

WindowLook describe(Onlooker& run, std::uint32_t w)
{
  const auto& control = run.control();
  const auto& record = control.windows[w];
  const auto& view = run.view(w);
  const auto& levels = control.table(control.epoch.load()).windows[w];
  WindowLook look;
  look.name = record.name;
  look.owner = record.owner == shm::Owner::module ? name_of(control, record.module) : "driver";
  look.generation = record.generation;
  look.dimension = view.header().dimension;
  look.committed_levels = levels.n_slots - 1;
  look.bytes = record.bytes;
  look.step = levels.committed[0].step;
  look.time = levels.committed[0].time;
  for (const auto& pane : view.panes()) {
    look.nodes += pane.n_nodes;
    look.elements += pane.n_elements;
  }
  for (const auto& field : view.fields()) {
    FieldLook f;
    f.name = field.name;
    f.unit = field.unit;
    f.location = word(locations, field.location);
    f.role = word(roles, field.role);
    f.nature = word(natures, field.nature);
    f.pane = field.pane;
    f.components = field.components;
    f.entities = field.entities;
    if (static_cast<shm::Storage>(field.storage) == shm::Storage::bound)
      f.source = fmt::format("{}.{}", control.windows[field.source_window].name,
                             run.view(field.source_window).fields()[field.source_field].name);
    look.fields.push_back(std::move(f));
  }
  return look;
}

void add_numbers(FieldLook& field, const std::vector<std::byte>& bytes, std::uint32_t scalar, std::size_t n_values)
{
  const auto n = bytes.size() / shm::scalar_bytes(scalar);
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    double value = 0.0;
    if (scalar == MULLION_I32) {
      std::int32_t integer = 0;
      std::memcpy(&integer, bytes.data() + 4 * i, sizeof integer);
      value = integer;
    } else std::memcpy(&value, bytes.data() + 8 * i, sizeof value);
    field.smallest = i == 0 ? value : std::min(field.smallest, value);
    field.largest = i == 0 ? value : std::max(field.largest, value);
    sum += value;
    squares += value * value;
    if (i < n_values) field.values.push_back(value);
  }
  field.mean = n == 0 ? 0.0 : sum / static_cast<double>(n);
  field.norm = std::sqrt(squares);
}

/// "structure.wet.displacement" as window and field; the field may be "".
std::pair<std::uint32_t, std::string> find(Onlooker& run, const std::string& path)
{
  const auto& control = run.control();
  auto name = path;
  if (name.find('/') == std::string::npos)
    if (const auto dot = name.find('.'); dot != std::string::npos) name[dot] = '/';
  if (const auto w = control.find_window(name); w != shm::no_window) return {w, ""};
  const auto dot = name.rfind('.');
  const auto window = name.substr(0, dot);
  if (const auto w = control.find_window(window); dot != std::string::npos && w != shm::no_window)
    return {w, name.substr(dot + 1)};
  std::vector<std::string> known;
  for (std::uint32_t w = 0; w < control.n_windows; ++w) known.emplace_back(control.windows[w].name);
  const auto nearest = config::nearest_name(name, known);
  throw Error(Errc::config,
              fmt::format("run '{}' has no window '{}'{}", control.run_name, nearest.empty() ? window : name,
                          config::suggestion(nearest.empty() ? window : name, known)));
}

Json json_of(const FieldLook& f, bool has_numbers)
{
  Json json{{"name", f.name},     {"unit", f.unit}, {"location", f.location},     {"role", f.role},
            {"nature", f.nature}, {"pane", f.pane}, {"components", f.components}, {"entities", f.entities},
            {"source", f.source}};
  if (!has_numbers) return json;
  json["min"] = f.smallest;
  json["max"] = f.largest;
  json["mean"] = f.mean;
  json["norm"] = f.norm;
  json["values"] = f.values;
  return json;
}

Json json_of(const WindowLook& w, bool has_numbers)
{
  Json fields = Json::array();
  for (const auto& field : w.fields) fields.push_back(json_of(field, has_numbers));
  return {{"name", w.name},
          {"owner", w.owner},
          {"generation", w.generation},
          {"dimension", w.dimension},
          {"committed_levels", w.committed_levels},
          {"bytes", w.bytes},
          {"nodes", w.nodes},
          {"elements", w.elements},
          {"step", w.step},
          {"time", w.time},
          {"fields", fields}};
}

} // namespace

RunLook look_at_run(const std::string& name)
{
  Onlooker run(name);
  const auto& control = run.control();
  RunLook look;
  look.name = control.run_name;
  look.guard = control.guard_pid;
  look.orchestrator = control.orchestrator_pid;
  look.step = control.step;
  look.n_steps = control.n_steps;
  look.time = control.time;
  if (const auto current = control.current; current.module < control.n_modules)
    look.at_work = fmt::format("{}: {}", name_of(control, current.module), shm::to_string(current.operation));
  const auto timings = process::ask(name, "timings").at("timings");
  for (std::uint32_t m = 0; m < control.n_modules; ++m) {
    const auto& record = control.modules[m];
    ModuleLook module{record.name,        record.kind, record.plugin, record.is_inline != 0, record.pid,
                      record.incarnation, {}};
    if (m < timings.size())
      for (const auto& call : timings[m])
        if (const std::int64_t count = call.at("count"); count > 0)
          module.calls.push_back({call.at("call"), count, call.at("wall_s"), call.at("work_s")});
    look.modules.push_back(std::move(module));
  }
  for (std::uint32_t w = 0; w < control.n_windows; ++w) look.windows.push_back(describe(run, w));
  return look;
}

WindowLook look_at_window(const std::string& name, const std::string& path, std::size_t n_values)
{
  Onlooker run(name);
  const auto [w, wanted] = find(run, path);
  auto look = describe(run, w);
  std::vector<std::uint32_t> fields;
  std::vector<std::string> known;
  for (std::uint32_t f = 0; f < look.fields.size(); ++f) {
    known.push_back(look.fields[f].name);
    if (wanted.empty() || look.fields[f].name == wanted) fields.push_back(f);
  }
  MULLION_REQUIRE(!fields.empty() || wanted.empty(), Errc::config, "window {} of run '{}' has no field '{}'{}",
                  look.name, name, wanted, config::suggestion(wanted, known));
  const auto copy = run.copy(w, fields);
  look.step = copy.stamp.step;
  look.time = copy.stamp.time;
  std::vector<FieldLook> shown;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    auto& field = shown.emplace_back(std::move(look.fields[fields[i]]));
    add_numbers(field, copy.fields[i], run.view(w).fields()[fields[i]].scalar, n_values);
  }
  look.fields = std::move(shown);
  return look;
}

std::string to_json(const WindowLook& window) { return json_of(window, true).dump(2); }

std::string to_json(const RunLook& run)
{
  Json modules = Json::array(), windows = Json::array();
  for (const auto& m : run.modules) {
    Json calls = Json::array();
    for (const auto& c : m.calls)
      calls.push_back({{"call", c.call}, {"count", c.count}, {"wall_s", c.wall_s}, {"work_s", c.work_s}});
    modules.push_back({{"instance", m.instance},
                       {"kind", m.kind},
                       {"plugin", m.plugin},
                       {"inline", m.is_inline},
                       {"pid", m.pid},
                       {"incarnation", m.incarnation},
                       {"calls", calls}});
  }
  for (const auto& w : run.windows) windows.push_back(json_of(w, false));
  return Json{{"name", run.name},       {"guard", run.guard},   {"orchestrator", run.orchestrator},
              {"step", run.step},       {"steps", run.n_steps}, {"time", run.time},
              {"at_work", run.at_work}, {"modules", modules},   {"windows", windows}}
      .dump(2);
}

} // namespace mullion
