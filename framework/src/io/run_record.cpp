#include "io/run_record.hpp"

#include "io/atomic_file.hpp"

#include <mullion/sdk/error.hpp>

#include <nlohmann/json.hpp>

#include <array>
#include <ctime>
#include <limits>

namespace mullion::io {
namespace {

using Json = nlohmann::ordered_json;

/// Whole numbers and texts by their type; a real may be null (it was not finite).
template <class T> void take(const Json& json, const char* key, T& value)
{
  if (const auto found = json.find(key); found != json.end()) value = found->template get<T>();
}

void take(const Json& json, const char* key, double& value)
{
  if (const auto found = json.find(key); found != json.end())
    value = found->is_null() ? std::numeric_limits<double>::quiet_NaN() : found->get<double>();
}

template <class T, class Convert>
void take_list(const Json& json, const char* key, std::vector<T>& list, Convert convert)
{
  if (const auto found = json.find(key); found != json.end())
    for (const auto& entry : *found) list.push_back(convert(entry));
}

template <class T, class Convert> Json to_list(const std::vector<T>& list, Convert convert)
{
  Json json = Json::array();
  for (const auto& entry : list) json.push_back(convert(entry));
  return json;
}

Json module_to_json(const PlacedModule& m)
{
  return {{"instance", m.instance},
          {"kind", m.kind},
          {"module", m.module},
          {"version", m.version},
          {"process", m.is_process}};
}

PlacedModule module_from_json(const Json& json)
{
  PlacedModule m;
  take(json, "instance", m.instance);
  take(json, "kind", m.kind);
  take(json, "module", m.module);
  take(json, "version", m.version);
  take(json, "process", m.is_process);
  return m;
}

Json timing_to_json(const Timing& t)
{
  return {{"who", t.who},       {"call", t.call},     {"count", t.count},
          {"wall_s", t.wall_s}, {"work_s", t.work_s}, {"wait_s", t.wait_s}};
}

Timing timing_from_json(const Json& json)
{
  Timing t;
  take(json, "who", t.who);
  take(json, "call", t.call);
  take(json, "count", t.count);
  take(json, "wall_s", t.wall_s);
  take(json, "work_s", t.work_s);
  take(json, "wait_s", t.wait_s);
  return t;
}

Json event_to_json(const Event& e)
{
  return {{"step", e.step}, {"what", e.what}, {"instance", e.instance}, {"detail", e.detail}};
}

Event event_from_json(const Json& json)
{
  Event e;
  take(json, "step", e.step);
  take(json, "what", e.what);
  take(json, "instance", e.instance);
  take(json, "detail", e.detail);
  return e;
}

Json attempt_to_json(const Attempt& a)
{
  Json json;
  json["outcome"] = a.outcome;
  json["error"] = a.error;
  json["start"] = a.start;
  json["versions"] = Json::object();
  for (const auto& [what, version] : a.versions) json["versions"][what] = version;
  json["driver"] = a.driver;
  json["modules"] = to_list(a.modules, module_to_json);
  json["restarted_from"] = a.restarted_from;
  json["first_step"] = a.first_step;
  json["steps"] = a.steps;
  json["simulated_time"] = a.simulated_time;
  json["wall_s"] = a.wall_s;
  if (!a.functions.empty()) {
    json["functions"] = Json::object();
    for (const auto& [call, answer] : a.functions) json["functions"][call] = answer;
  }
  json["timings"] = to_list(a.timings, timing_to_json);
  json["events"] = to_list(a.events, event_to_json);
  json["files"] = a.files;
  return json;
}

Attempt attempt_from_json(const Json& json)
{
  Attempt a;
  take(json, "outcome", a.outcome);
  take(json, "error", a.error);
  take(json, "start", a.start);
  if (const auto versions = json.find("versions"); versions != json.end())
    for (const auto& [what, version] : versions->items()) a.versions.emplace_back(what, version.get<std::string>());
  take(json, "driver", a.driver);
  take_list(json, "modules", a.modules, module_from_json);
  take(json, "restarted_from", a.restarted_from);
  take(json, "first_step", a.first_step);
  take(json, "steps", a.steps);
  take(json, "simulated_time", a.simulated_time);
  take(json, "wall_s", a.wall_s);
  if (const auto functions = json.find("functions"); functions != json.end())
    for (const auto& [call, answer] : functions->items())
      if (answer.is_number()) a.functions.emplace_back(call, answer.get<double>()); // null: was not finite
  take_list(json, "timings", a.timings, timing_from_json);
  take_list(json, "events", a.events, event_from_json);
  take(json, "files", a.files);
  return a;
}

} // namespace

std::optional<RunRecord> read_run_record(const std::filesystem::path& path)
{
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::nullopt;
  try {
    const auto json = Json::parse(read_text(path));
    RunRecord record;
    json.at("name").get_to(record.name);
    json.at("outcome").get_to(record.outcome);
    if (const auto columns = json.find("columns"); columns != json.end())
      for (const auto& [column, unit] : columns->items()) record.columns.emplace_back(column, unit.get<std::string>());
    take_list(json, "attempts", record.attempts, attempt_from_json);
    return record;
  } catch (const nlohmann::json::exception& failure) {
    throw Error(Errc::io, fmt::format("{} is not the record of a run: {}; move it away to start anew", path.string(),
                                      failure.what()));
  }
}

void write_run_record(const std::filesystem::path& path, const RunRecord& record)
{
  Json json;
  json["name"] = record.name;
  json["outcome"] = record.outcome;
  json["columns"] = Json::object();
  for (const auto& [column, unit] : record.columns) json["columns"][column] = unit;
  json["attempts"] = to_list(record.attempts, attempt_to_json);
  write_atomically(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

void complete_after_crash(const std::string& path, const std::string& outcome, const std::string& message)
{
  auto record = read_run_record(path).value_or(RunRecord{});
  if (record.outcome != "running") return;
  if (record.attempts.empty()) record.attempts.emplace_back();
  record.outcome = outcome;
  record.attempts.back().outcome = outcome;
  record.attempts.back().error = message;
  write_run_record(path, record);
}

std::string utc_now()
{
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 32> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text.data();
}

} // namespace mullion::io
