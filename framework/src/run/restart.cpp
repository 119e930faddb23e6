#include "run/restart.hpp"

#include "config/case_reader.hpp"
#include "config/toml_reader.hpp"
#include "config/toml_writer.hpp"
#include "io/checkpoint_files.hpp"
#include "io/checkpoint_trial.hpp"
#include "log/console.hpp"
#include "run/checkpoint.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <map>
#include <vector>

namespace mullion::run {
namespace {

namespace fs = std::filesystem;

// ---- which file ------------------------------------------------------------------------------------------------

fs::path newest_of(const fs::path& folder)
{
  std::vector<std::string> problems;
  const auto found = io::newest_good_checkpoint(folder, &problems);
  if (found) {
    for (const auto& problem : problems) log::warning("run", "{}; {} is taken instead", problem, found->path.string());
    return found->path;
  }
  MULLION_REQUIRE(problems.empty(), Errc::config, "--restart latest: no checkpoint in {} is sound: {}", folder.string(),
                  fmt::join(problems, "; "));
  throw Error(Errc::config,
              fmt::format("--restart latest: there is no checkpoint in {}; run without --restart to begin, "
                          "or say with --out where the results are",
                          folder.string()));
}

/// @param is_tried  newest_of() has read it in a child process
Restart read_restart(const fs::path& file, bool is_tried)
{
  try {
    if (!is_tried) io::try_checkpoint(file);
    return {file, io::read_checkpoint(file), {}};
  } catch (const Error& error) {
    const auto folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    const auto good = io::newest_good_checkpoint(folder);
    throw Error(Errc::config, fmt::format("--restart: {}; {}", error.what(),
                                          good ? fmt::format("the newest good one is {}", good->path.string())
                                               : fmt::format("there is no good one in {}", folder.string())));
  }
}

// ---- the same physics ------------------------------------------------------------------------------------------

std::string text_of(const ParameterValue& parameter)
{
  struct Write {
    std::string operator()(double value) const { return config::write_real(value); }
    std::string operator()(std::int64_t value) const { return fmt::format("{}", value); }
    std::string operator()(bool value) const { return value ? "true" : "false"; }
    std::string operator()(const std::string& value) const { return fmt::format("\"{}\"", value); }
  };
  return std::visit(Write{}, parameter.value);
}

/// Every key on which the numbers of a run depend, defaults included. Not among them: names, where modules live, the
/// end of the run, limits, what is written.
std::map<std::string, std::string> physics_of(const Case& c)
{
  std::map<std::string, std::string> keys;
  keys["run.start_time"] = config::write_real(c.start_time);
  keys["run.dt"] = config::write_real(c.dt);
  keys["coupling.reference_pressure"] = config::write_real(c.reference_pressure);
  std::vector<std::string> pairs;
  for (const auto& pair : c.interfaces) pairs.push_back(fmt::format("[\"{}\", \"{}\"]", pair.fluid, pair.structure));
  keys["coupling.interfaces"] = fmt::format("[{}]", fmt::join(pairs, ", "));
  for (const auto& module : c.modules) {
    keys[module.instance + ".module"] = fmt::format("\"{}\"", module.plugin);
    for (const auto& parameter : module.parameters)
      if (parameter.name != config::reference_pressure)
        keys[module.instance + "." + parameter.name] = text_of(parameter);
  }
  keys["driver.scheme"] = fmt::format("\"{}\"", c.scheme);
  for (const auto& parameter : c.driver_parameters) keys["driver." + parameter.name] = text_of(parameter);
  return keys;
}

/// Is the key, or the table that it stands in, among those that --set gave?
bool is_named(const std::string& key, const std::vector<std::string>& overrides)
{
  return std::any_of(overrides.begin(), overrides.end(), [&](const std::string& text) {
    const auto parts = config::parse_key(text.substr(0, text.find('=')));
    if (!parts) return false;
    const auto named = fmt::format("{}", fmt::join(*parts, "."));
    return key == named || key.starts_with(named + ".");
  });
}

/// @throws Error Errc::config naming every key that differs and that --set does not name
void check_physics(Restart& restart, const Case& now, const CaseOptions& options)
{
  auto then_options = options;
  then_options.overrides.clear();
  const auto then = read_case_text(restart.checkpoint.case_text, restart.file.string(), then_options);
  MULLION_REQUIRE(then.diagnostics.empty(), Errc::config,
                  "--restart {}: the case that it holds is none any more for this installation of Mullion and its "
                  "plug-ins: {}",
                  restart.file.string(), then.diagnostics.empty() ? "" : then.diagnostics[0].message);
  const auto here = physics_of(now), there = physics_of(then.value);
  std::vector<std::string> differences;
  const auto is_other_plugin = [&](const std::string& table) { // then its parameters are others, too
    for (const char* key : {".module", ".scheme"}) {
      const auto h = here.find(table + key), t = there.find(table + key);
      if (h != here.end() && t != there.end() && h->second != t->second) return true;
    }
    return false;
  };
  const auto compare = [&](const std::string& key) {
    const auto h = here.find(key), t = there.find(key);
    const auto dot = key.find('.');
    const bool names_plugin = key.ends_with(".module") || key.ends_with(".scheme");
    if (!names_plugin && is_other_plugin(key.substr(0, dot))) return;
    const auto text = [&](auto found, const auto& map) { return found == map.end() ? "absent" : found->second; };
    if (h != here.end() && t != there.end() && h->second == t->second) return;
    restart.changed.insert(key.substr(0, dot));
    if (!is_named(key, options.overrides))
      differences.push_back(fmt::format("{} is {} and was {}", key, text(h, here), text(t, there)));
  };
  for (const auto& entry : here) compare(entry.first);
  for (const auto& entry : there)
    if (!here.contains(entry.first)) compare(entry.first);
  MULLION_REQUIRE(differences.empty(), Errc::config,
                  "--restart {}: it was made by another case: {}; a change that is meant is named with --set",
                  restart.file.string(), fmt::join(differences, ", "));
}

void warn_of_other_plugins(const Restart& restart, const Case& now)
{
  std::map<std::string, std::string> checksums;
  const auto others = other_plugins(restart.checkpoint.plugins, plugins_of(now, checksums));
  if (!others.empty())
    log::warning("run",
                 "{} was made with other plug-ins ({}); the results may differ from those of a run that never "
                 "stopped",
                 restart.file.string(), fmt::join(others, "; "));
}

} // namespace

Begin begin_of(const RunOptions& options)
{
  Begin begin;
  const bool has_case = !options.case_file.empty();
  if (has_case) {
    begin.the_case = read_case(options.case_file, options.case_options);
    if (!begin.the_case.diagnostics.empty()) return begin;
    begin.out = options.out.empty() ? fs::path("out") / begin.the_case.value.name : fs::path(options.out);
    if (options.restart.empty()) return begin;
  } else {
    begin.out = options.out;
  }
  const bool is_latest = options.restart == "latest";
  const auto file = is_latest ? newest_of(begin.out) : fs::path(options.restart);
  begin.restart = read_restart(file, is_latest);
  if (!has_case) {
    begin.the_case = read_case_text(begin.restart->checkpoint.case_text, file.string(), options.case_options);
    if (!begin.the_case.diagnostics.empty()) return begin;
    if (begin.out.empty()) begin.out = file.has_parent_path() ? file.parent_path() : fs::path(".");
  }
  check_physics(*begin.restart, begin.the_case.value, options.case_options);
  warn_of_other_plugins(*begin.restart, begin.the_case.value);
  return begin;
}

} // namespace mullion::run
