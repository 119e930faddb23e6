#include "study/plan.hpp"

#include "io/atomic_file.hpp"

#include <mullion/coupling/build_id.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace mullion::study {
namespace {

std::string checksum(std::string_view text)
{
  return fmt::format("{:016x}", io::crc64(std::as_bytes(std::span(text))));
}

/// What the plug-ins are, by their content: one that was built anew may give other results under an old version.
class PluginChecksums {
public:
  const std::string& of(const std::string& path)
  {
    auto& known = known_[path];
    if (known.empty()) known = checksum(io::read_text(path));
    return known;
  }

private:
  std::map<std::string, std::string> known_;
};

std::string fingerprint(const StudyFile& study, const Case& the_case, PluginChecksums& plugins)
{
  std::string text =
      fmt::format("mullion {} build {}\nplacement {}\n", MULLION_VERSION, MULLION_BUILD_ID, study.placement);
  for (const auto& module : the_case.modules)
    text += fmt::format("{} {} {} {}\n", module.instance, module.plugin, module.version, plugins.of(module.path));
  text += fmt::format("{} {}\n{}", the_case.scheme, plugins.of(the_case.scheme_path), the_case.text);
  return checksum(text);
}

/// Mistakes of one run's case: where they come from an override, the study file is the place to mend.
std::vector<Diagnostic> explain(const StudyFile& study, std::size_t run, const std::vector<Diagnostic>& found)
{
  const auto which = study.axes.empty() ? "" : fmt::format("run {} ({}): ", run, study.describe_run(run));
  std::vector<Diagnostic> out;
  for (auto diagnostic : found) {
    for (const auto* setting : study.settings_of(run))
      if (diagnostic.place == "--set " + setting->override_text())
        diagnostic.place = fmt::format("{}:{}:{}", study.file, setting->place.line, setting->place.column);
    out.push_back({diagnostic.place, which + diagnostic.message});
  }
  return out;
}

/// Who turned the history off: an override, or the case.
std::string place_of_history(const StudyFile& study, std::size_t run)
{
  std::string place = study.case_file;
  for (const auto* setting : study.settings_of(run))
    if (setting->key == "output.history") place = "--set " + setting->override_text();
  return place;
}

} // namespace

bool needs_history(const std::string& kind) { return kind != "wall_time" && kind != "steps" && kind != "function"; }

std::string placement_flag(const StudyFile& study)
{
  return study.placement == "inline" ? "--inline" : study.placement == "processes" ? "--processes" : "";
}

Plan make_plan(const StudyFile& study)
{
  Plan plan;
  PluginChecksums plugins;
  const bool is_history_needed = std::any_of(study.measures.begin(), study.measures.end(),
                                             [](const MeasureSpec& measure) { return needs_history(measure.kind); });
  for (std::size_t r = 0; r < study.n_runs(); ++r) {
    auto& run = plan.runs.emplace_back();
    run.name = fmt::format("{}.{}", study.name, r);
    for (const auto* setting : study.settings_of(r)) run.overrides.push_back(setting->override_text());
    run.overrides.push_back(fmt::format("run.name=\"{}\"", run.name));
    auto result =
        read_case(study.case_file, {run.overrides, study.placement == "inline", study.placement == "processes"});
    if (result.diagnostics.empty() && is_history_needed && !result.value.has_history)
      result.diagnostics.push_back({place_of_history(study, r), "[output] history = false, but the study measures "
                                                                "history.csv; expected true"});
    if (!result.diagnostics.empty()) {
      plan.diagnostics = explain(study, r, result.diagnostics);
      return plan;
    }
    run.fingerprint = fingerprint(study, result.value, plugins);
  }
  return plan;
}

} // namespace mullion::study
