// The catalogue in words: what the plug-ins on the path declare, for people.
#include <mullion/app/catalogue.hpp>

#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_writer.hpp"
#include "plugin/catalogue.hpp"

#include <mullion/sdk/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <tuple>

namespace mullion {
namespace {

constexpr const char* kinds[] = {"fluid", "structure", "mesh_motion", "transfer", "driver"};

std::string or_nothing(const char* text) { return text == nullptr ? "" : text; }

PluginSummary summary_of(const plugin::Library& library)
{
  const auto& header = library.header();
  return {or_nothing(header.name),    or_nothing(header.kind), or_nothing(header.version),
          or_nothing(header.summary), library.path(),          ""};
}

template <std::size_t N> std::string name_of(const char* const (&names)[N], std::uint32_t value)
{
  return value < N ? names[value] : "unknown";
}
constexpr const char* types[] = {"real", "integer", "boolean", "text"};
constexpr const char* locations[] = {"node", "element", "pane"};
constexpr const char* roles[] = {"state", "output", "fixed"};
constexpr const char* natures[] = {"intensive", "extensive"};

std::string components(std::uint32_t n) { return n == 0 ? "vector" : fmt::format("{}", n); }

std::string default_text(const mullion_parameter_spec& spec)
{
  if (spec.is_required != 0) return "required";
  config::Node node;
  std::visit([&](const auto& value) { node.value = value; }, config::default_value(spec).value);
  return config::write_value(node);
}

ParameterRow row_of(const mullion_parameter_spec& spec)
{
  return {spec.name,
          name_of(types, spec.type),
          or_nothing(spec.unit),
          default_text(spec),
          config::range_text(spec),
          or_nothing(spec.meaning) + (spec.is_changeable != 0 ? "; changeable" : "")};
}

FunctionRow row_of(const mullion_function_spec& spec)
{
  const auto arguments = fmt::format("({} number{})", spec.n_arguments, spec.n_arguments == 1 ? "" : "s");
  const bool is_action = spec.n_results == 0;
  return {spec.name,
          is_action ? fmt::format("writes {}", or_nothing(spec.writes))
                    : fmt::format("{} -> number", spec.n_arguments == 0 ? "()" : arguments),
          or_nothing(spec.meaning)};
}

} // namespace

std::vector<PluginSummary> list_plugins()
{
  plugin::Catalogue catalogue;
  std::vector<PluginSummary> out;
  for (const auto& name : catalogue.names()) {
    try {
      out.push_back(summary_of(catalogue.open(name)));
    } catch (const std::exception& error) {
      out.push_back({name, "", "", "", catalogue.find(name), error.what()});
    }
  }
  const auto rank = [](const PluginSummary& plugin) {
    const auto place = std::find(std::begin(kinds), std::end(kinds), plugin.kind) - std::begin(kinds);
    return std::tuple(place, plugin.name);
  };
  std::sort(out.begin(), out.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
  return out;
}

std::vector<std::string> plugin_folders() { return plugin::Catalogue().folders(); }

PluginReference describe_plugin(const std::string& name)
{
  plugin::Catalogue catalogue;
  const auto& library = catalogue.open(name);
  PluginReference out{summary_of(library), {}, {}, {}, {}};
  for (const auto& spec : library.parameters()) out.parameters.push_back(row_of(spec));
  if (library.is_driver()) return out;
  const auto& module = library.module();
  for (const auto& spec : std::span(module.fields, module.n_fields))
    out.fields.push_back({fmt::format("{}.{}", spec.window, spec.name), or_nothing(spec.unit),
                          name_of(locations, spec.location), components(spec.components), name_of(roles, spec.role),
                          name_of(natures, spec.nature), or_nothing(spec.meaning)});
  for (const auto& spec : std::span(module.inputs, module.n_inputs))
    out.inputs.push_back({fmt::format("{}.{}", spec.window, spec.name), or_nothing(spec.unit),
                          name_of(locations, spec.location), components(spec.components),
                          spec.is_required != 0 ? "required" : "optional", name_of(natures, spec.nature),
                          or_nothing(spec.meaning)});
  for (const auto& spec : std::span(module.functions, module.n_functions)) out.functions.push_back(row_of(spec));
  return out;
}

std::string did_you_mean(const std::string& given, const std::vector<std::string>& known)
{
  return config::suggestion(given, known);
}

} // namespace mullion
