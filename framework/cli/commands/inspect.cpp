// `mullion inspect RUN [WINDOW[.FIELD]]`: a look into a live run.
#include "commands/arguments.hpp"

#include <mullion/app/inspect.hpp>
#include <mullion/app/live_runs.hpp>
#include <mullion/sdk/error.hpp>

#include <boost/program_options/value_semantic.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

namespace mullion::cli {

namespace po = boost::program_options;

namespace {

constexpr int most_values = 10000;

void print(const RunLook& run)
{
  fmt::print("run {}: step {}/{}, t = {:.9g} s, guard {}, orchestrator {}{}\n", run.name, run.step, run.n_steps,
             run.time, run.guard, run.orchestrator, run.at_work.empty() ? "" : ", at work: " + run.at_work);
  fmt::print("\n{:<14} {:<14} {:<20} {:>8} {:<14} {:>10} {:>11} {:>11}\n", "module", "kind", "plug-in", "process",
             "call", "count", "work/call", "wait/call");
  for (const auto& m : run.modules) {
    const auto process = m.is_inline ? std::string("inline") : fmt::format("{}", m.pid);
    std::string head = fmt::format("{:<14} {:<14} {:<20} {:>8}", m.instance, m.kind, m.plugin, process);
    if (m.calls.empty()) fmt::print("{}\n", head);
    for (const auto& c : m.calls) {
      const double n = static_cast<double>(c.count);
      fmt::print("{} {:<14} {:>10} {:>8.1f} us {:>8.1f} us\n", head, c.call, c.count, 1e6 * c.work_s / n,
                 1e6 * (c.wall_s - c.work_s) / n);
      head.assign(head.size(), ' ');
    }
  }
  fmt::print("\n{:<28} {:<12} {:>6} {:>9} {:>9} {:>12} {}\n", "window", "written by", "levels", "nodes", "elements",
             "bytes", "fields");
  for (const auto& w : run.windows) {
    std::vector<std::string> names;
    for (const auto& f : w.fields)
      if (f.pane == 0) names.push_back(f.name);
    fmt::print("{:<28} {:<12} {:>6} {:>9} {:>9} {:>12} {}\n", w.name, w.owner, w.committed_levels, w.nodes, w.elements,
               w.bytes, fmt::join(names, " "));
  }
}

void print(const WindowLook& w, bool has_values)
{
  fmt::print("{}: step {}, t = {:.9g} s, written by {}, {} nodes, {} elements\n", w.name, w.step, w.time, w.owner,
             w.nodes, w.elements);
  fmt::print("{:<24} {:>10} {:<8} {:>12} {:>14} {:>14} {:>14} {:>14}\n", "field", "unit", "on", "values", "min", "max",
             "mean", "norm");
  for (const auto& f : w.fields) {
    fmt::print("{:<24} {:>10} {:<8} {:>12} {:>14.6g} {:>14.6g} {:>14.6g} {:>14.6g}{}\n",
               f.pane == 0 ? f.name : fmt::format("{}[pane {}]", f.name, f.pane), f.unit, f.location,
               fmt::format("{} x {}", f.components, f.entities), f.smallest, f.largest, f.mean, f.norm,
               f.source.empty() ? "" : "  = " + f.source);
    if (!has_values) continue;
    for (std::size_t i = 0; i < f.values.size(); i += f.components) {
      const auto last = std::min(f.values.size(), i + f.components);
      fmt::print("  [{}] {}\n", i / f.components,
                 fmt::join(f.values.begin() + static_cast<std::ptrdiff_t>(i),
                           f.values.begin() + static_cast<std::ptrdiff_t>(last), " "));
    }
    const auto n = static_cast<std::size_t>(f.entities) * f.components;
    if (f.values.size() < n) fmt::print("  … {} values in all; --values N shows more\n", n);
  }
}

void look(const std::string& run, const std::string& path, std::size_t n_values, bool is_json)
{
  if (path.empty()) {
    const auto seen = look_at_run(run);
    if (is_json) fmt::print("{}\n", to_json(seen));
    else print(seen);
  } else {
    const auto seen = look_at_window(run, path, n_values);
    if (is_json) fmt::print("{}\n", to_json(seen));
    else print(seen, n_values > 0);
  }
  std::fflush(stdout);
}

bool is_alive(const std::string& run)
{
  const auto runs = list_live_runs();
  return std::any_of(runs.begin(), runs.end(), [&](const LiveRun& live) { return live.name == run; });
}

} // namespace

int run_inspect(const Arguments& arguments)
{
  CommandLine command{"mullion inspect RUN [WINDOW[.FIELD]] [options]",
                      "Look into a live run: its modules, timings and windows; the fields of one window with minimum,\n"
                      "maximum, mean and norm; the values of one field. The run notices nothing.",
                      {},
                      "run",
                      2};
  command.options.add_options()("values", po::value<int>()->value_name("N"),
                                "of each field at most N values (default: 10 of a single field, 0 of a whole window)")(
      "json", "as JSON")("follow", po::value<double>()->value_name("SECONDS")->implicit_value(1.0, "1"),
                         "again and again, until the run ends");
  const auto given = parse_arguments(command, arguments);
  if (!given) return success;
  if (given->count("run") == 0) throw UsageError("no run given; 'mullion ps' lists the live ones");
  const auto words = (*given)["run"].as<Arguments>();
  const auto path = words.size() > 1 ? words[1] : "";
  int n_values = std::count(path.begin(), path.end(), '.') + std::count(path.begin(), path.end(), '/') >= 2 ? 10 : 0;
  if (given->count("values") != 0) n_values = (*given)["values"].as<int>();
  if (n_values < 0 || n_values > most_values) throw UsageError(fmt::format("--values takes 0 to {}", most_values));
  const bool is_json = given->count("json") != 0;

  if (given->count("follow") == 0) {
    look(words[0], path, static_cast<std::size_t>(n_values), is_json);
    return success;
  }
  const double seconds = (*given)["follow"].as<double>();
  if (!(seconds > 0.0)) throw UsageError("--follow takes a number of seconds above 0");
  for (bool is_first = true;; is_first = false) {
    try {
      look(words[0], path, static_cast<std::size_t>(n_values), is_json);
    } catch (const Error&) {
      if (is_first || is_alive(words[0])) throw;
      return success; // it has ended: there is no more to see
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  }
}

} // namespace mullion::cli
