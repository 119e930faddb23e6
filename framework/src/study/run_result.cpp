#include "study/run_result.hpp"

#include "io/atomic_file.hpp"
#include "io/run_record.hpp"
#include "process/supervisor.hpp"
#include "study/measure_table.hpp"
#include "study/plan.hpp"

#include <mullion/sdk/error.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sys/wait.h>

namespace mullion::study {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string checksum(std::string_view text)
{
  return fmt::format("{:016x}", io::crc64(std::as_bytes(std::span(text))));
}

std::string one_line(const std::string& text)
{
  std::string out;
  for (const char c : text) {
    if (c == '\n' || c == '\r') out += out.ends_with("; ") ? "" : "; ";
    else out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  while (out.ends_with(' ') || out.ends_with(';')) out.pop_back();
  return out;
}

/// The last message that the run printed; "" if it printed none.
std::string printed_error(const fs::path& output)
{
  constexpr std::string_view mark = "mullion: error: ";
  std::error_code none;
  if (!fs::exists(output, none)) return "";
  const auto text = io::read_text(output);
  const auto begin = text.rfind(mark);
  if (begin == std::string::npos) return "";
  return text.substr(begin + mark.size(), text.find('\n', begin) - begin - mark.size());
}

bool can_be_measured(const RunResult& result, const Measuring& measuring)
{
  return result.outcome != "failed" || (measuring.measures_failed && !result.has_died);
}

bool is_history_needed(const RunResult& result, const Measuring& measuring)
{
  return can_be_measured(result, measuring) && std::any_of(measuring.measures.begin(), measuring.measures.end(),
                                                           [](const Measure& m) { return needs_history(m.kind); });
}

std::string definition_of_all(const Measuring& measuring)
{
  std::string text = measuring.measures_failed ? "failed too\n" : "";
  for (const auto& m : measuring.measures) text += definition_of(m) + "\n";
  return checksum(text);
}

/// Process numbers differ from run to run; the table of the same study must not.
std::string without_numbers(const std::string& message)
{
  static const std::regex process("\\bprocess \\d+");
  return std::regex_replace(message, process, "process");
}

/// Every measure of a history; those that cannot be taken are told and leave their columns empty.
void measure_history(RunResult& result, const ColumnTable& history, const std::string& problem,
                     const Measuring& measuring)
{
  for (const auto& m : measuring.measures) {
    const auto n_columns = columns_of(m).size();
    try {
      if (needs_history(m.kind) && !problem.empty()) throw Error(Errc::io, problem);
      auto values = evaluate(m, history, {result.wall_s, result.steps, result.functions});
      for (auto& value : values)
        if (value && !std::isfinite(*value)) value.reset();
      result.values.insert(result.values.end(), values.begin(), values.end());
    } catch (const Error& error) {
      result.problems.push_back(one_line(fmt::format("{}: {}", m.name, error.what())));
      result.values.resize(result.values.size() + n_columns);
    }
  }
}

} // namespace

RunResult collect(const fs::path& folder, int status)
{
  RunResult result;
  const bool has_ended_well = WIFEXITED(status) && WEXITSTATUS(status) == 0;
  std::optional<io::RunRecord> record;
  try {
    record = io::read_run_record(folder / "run.json");
  } catch (const Error& error) {
    result.message = one_line(error.what());
  }
  if (record && !record->attempts.empty()) {
    const auto& attempt = record->attempts.back();
    result.outcome = record->outcome;
    result.message = without_numbers(one_line(attempt.error));
    result.steps = attempt.steps;
    result.wall_s = attempt.wall_s;
    result.functions = attempt.functions;
  }
  const bool is_closed = result.outcome == "completed" || result.outcome == "stopped" || result.outcome == "failed";
  result.has_died = !is_closed;
  if (has_ended_well && (result.outcome == "completed" || result.outcome == "stopped")) return result;
  result.outcome = "failed";
  if (result.message.empty()) result.message = without_numbers(one_line(printed_error(folder / "output.txt")));
  if (result.message.empty()) result.message = "the process of the run " + process::describe_end(status);
  return result;
}

void measure(RunResult& result, const fs::path& folder, const Measuring& measuring)
{
  result.values.clear();
  result.problems.clear();
  if (!can_be_measured(result, measuring)) return;
  ColumnTable history;
  std::string problem;
  if (is_history_needed(result, measuring)) {
    try {
      const auto text = io::read_text(folder / "history.csv");
      result.history = checksum(text);
      history = parse_columns(text, "history.csv");
    } catch (const Error& error) {
      problem = error.what();
    }
  }
  measure_history(result, history, problem, measuring);
}

void write_result(const fs::path& folder, const RunResult& result, const Measuring& measuring)
{
  Json json;
  json["fingerprint"] = result.fingerprint;
  json["outcome"] = result.outcome;
  json["message"] = result.message;
  json["died"] = result.has_died;
  json["steps"] = result.steps;
  json["wall_s"] = result.wall_s;
  if (!result.functions.empty()) {
    json["functions"] = Json::object();
    for (const auto& [call, answer] : result.functions) json["functions"][call] = answer;
  }
  json["history"] = result.history;
  json["definition"] = definition_of_all(measuring);
  json["values"] = Json::array();
  for (const auto& value : result.values) json["values"].push_back(value ? Json(*value) : Json());
  json["problems"] = result.problems;
  io::write_atomically(folder / "done.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

std::optional<RunResult> read_result(const fs::path& folder, const std::string& fingerprint, const Measuring& measuring)
{
  std::error_code none;
  if (!fs::exists(folder / "done.json", none)) return std::nullopt;
  RunResult result;
  try {
    const auto json = Json::parse(io::read_text(folder / "done.json"));
    json.at("fingerprint").get_to(result.fingerprint);
    json.at("outcome").get_to(result.outcome);
    json.at("message").get_to(result.message);
    json.at("died").get_to(result.has_died);
    json.at("steps").get_to(result.steps);
    json.at("wall_s").get_to(result.wall_s);
    if (const auto functions = json.find("functions"); functions != json.end())
      for (const auto& [call, answer] : functions->items())
        if (answer.is_number()) result.functions.emplace_back(call, answer.get<double>());
    json.at("history").get_to(result.history);
    json.at("definition").get_to(result.definition);
    for (const auto& value : json.at("values"))
      result.values.push_back(value.is_null() ? std::nullopt : std::optional(value.get<double>()));
    json.at("problems").get_to(result.problems);
  } catch (const nlohmann::json::exception&) {
    return std::nullopt; // no record of ours: the run is done again
  }
  if (result.fingerprint != fingerprint) return std::nullopt;
  const bool has_definition = result.definition == definition_of_all(measuring);
  if (!is_history_needed(result, measuring)) {
    measure(result, folder, measuring);
    if (!has_definition) write_result(folder, result, measuring);
    return result;
  }
  if (!fs::exists(folder / "history.csv", none))
    return has_definition ? std::optional(std::move(result)) : std::nullopt;
  const bool is_altered = !result.history.empty() && checksum(io::read_text(folder / "history.csv")) != result.history;
  if (is_altered) return std::nullopt;
  measure(result, folder, measuring);
  if (!has_definition) write_result(folder, result, measuring);
  return result;
}

void tidy(const fs::path& folder, const RunResult& result, const std::string& keep)
{
  if (keep == "all") return;
  std::error_code none; // what cannot be removed does no harm
  for (const char* name : {"results", "results.h5", "results.xdmf"}) fs::remove_all(folder / name, none);
  if (keep != "none" || result.outcome == "failed" || !result.problems.empty()) return;
  for (const char* name : {"history.csv", "run.json", "case.toml", "output.txt"}) fs::remove(folder / name, none);
}

} // namespace mullion::study
