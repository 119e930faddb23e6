// [coupling]: which interface windows face each other, and the reference pressure that all modules share.
#include "config/case_reader.hpp"
#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "config/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace mullion::config {
namespace {

constexpr const char* example = "interfaces = [[\"fluid.wall\", \"structure.wet\"]]";

struct CouplingOptions {
  double reference_pressure = 0.0;
  double displacement_limit = 0.0;
  static constexpr auto table()
  {
    return std::tuple{parameter("reference_pressure", &CouplingOptions::reference_pressure, "Pa",
                                "pressure that the fluid subtracts from its wall traction"),
                      parameter("displacement_limit", &CouplingOptions::displacement_limit, "m",
                                "the run ends when the wet surface moves further; 0: no limit", at_least(0.0))};
  }
};

std::vector<std::string> windows_of(const mullion_module& module)
{
  std::vector<std::string> windows;
  for (const auto& field : std::span(module.fields, module.n_fields))
    if (std::find(windows.begin(), windows.end(), field.window) == windows.end()) windows.emplace_back(field.window);
  return windows;
}

/// One side of the pair; false after a diagnostic.
bool check_side(CaseReader& reader, const Node& node, const std::string& kind, bool are_modules_known)
{
  const std::string& side = *node.text();
  const auto wrong = [&](const std::string& message) {
    reader.diagnostics.add(node.place, fmt::format("[coupling] interfaces: \"{}\" {}", side, message));
    return false;
  };
  const auto dot = side.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == side.size() || side.find('.', dot + 1) != std::string::npos)
    return wrong(fmt::format("is no interface window; expected instance.window, say {}", example));
  const auto instance = side.substr(0, dot), window = side.substr(dot + 1);

  const ModuleCase* module = reader.module(instance);
  if (module == nullptr) {
    const auto* entry = reader.root.table()->find(instance);
    if (!are_modules_known && entry != nullptr) return false; // its own table says what is wrong with it
    std::vector<std::string> known;
    for (const auto& m : reader.value.modules) known.push_back(m.instance);
    return wrong(fmt::format("names no module of this case{}", suggestion(instance, known)));
  }
  if (module->kind != kind)
    return wrong(fmt::format("is a window of a {}; expected one of a {} here: a pair is [fluid's window, structure's "
                             "window]",
                             module->kind, kind));
  const auto windows = windows_of(reader.catalogue.open(module->plugin).module());
  if (std::find(windows.begin(), windows.end(), window) == windows.end())
    return wrong(fmt::format("names no window of {}{}", module->plugin, suggestion(window, windows)));
  return true;
}

/// One side of an interface without the other: nothing to couple.
bool has_one_solver(const Case& value)
{
  const auto has = [&](std::string_view kind) {
    return std::any_of(value.modules.begin(), value.modules.end(), [&](const auto& m) { return m.kind == kind; });
  };
  return has("fluid") != has("structure");
}

bool read_interfaces(CaseReader& reader, const Node& coupling, bool are_modules_known)
{
  const auto wrong = [&](const Place& place, const std::string& message) {
    reader.diagnostics.add(place, "[coupling] " + message);
    return false;
  };
  const auto* entry = coupling.table()->find("interfaces");
  if (entry == nullptr && are_modules_known && has_one_solver(reader.value)) return true;
  if (entry == nullptr)
    return wrong(coupling.place, fmt::format("has no 'interfaces'; expected the pair of windows that face each other: "
                                             "{}",
                                             example));
  const Node& node = entry->value;
  const List* pairs = node.list();
  if (pairs == nullptr)
    return wrong(node.place, fmt::format("interfaces = {}; expected a list of pairs: {}", describe(node), example));
  bool is_sound = true;
  for (const auto& pair : *pairs) {
    const List* sides = pair.list();
    const bool is_pair =
        sides != nullptr && sides->size() == 2 && (*sides)[0].text() != nullptr && (*sides)[1].text() != nullptr;
    if (!is_pair)
      is_sound = wrong(pair.place, fmt::format("interfaces: {} is no pair of windows; expected two texts: {}",
                                               write_value(pair), example));
  }
  if (!is_sound) return false;
  if (pairs->size() != 1)
    return wrong(node.place,
                 fmt::format("interfaces has {} pairs; exactly one is supported today: {}", pairs->size(), example));
  const List& sides = *(*pairs)[0].list();
  const bool is_fluid_sound = check_side(reader, sides[0], "fluid", are_modules_known);
  const bool is_structure_sound = check_side(reader, sides[1], "structure", are_modules_known);
  if (is_fluid_sound && is_structure_sound) reader.value.interfaces.push_back({*sides[0].text(), *sides[1].text()});
  return is_fluid_sound && is_structure_sound;
}

/// Hand the pressure to every module that declares one; the declaration may ask for it or limit it.
void distribute_reference_pressure(CaseReader& reader, const Place& header, const Node* given)
{
  for (auto& module : reader.value.modules) {
    const auto specs = reader.catalogue.open(module.plugin).parameters();
    for (std::size_t i = 0; i < specs.size(); ++i) {
      if (specs[i].name != reference_pressure) continue;
      const Node value{given == nullptr ? header : given->place, reader.value.reference_pressure};
      if (given == nullptr && specs[i].is_required != 0) {
        reader.diagnostics.add(header,
                               fmt::format("[coupling] has no '{}'; [{}] (plug-in {}) needs it: expected {}: {}",
                                           reference_pressure, module.instance, module.plugin, expected(specs[i]),
                                           specs[i].meaning));
        continue;
      }
      if (const auto wrong = take_value(value, specs[i], module.parameters[i]); !wrong.empty())
        reader.diagnostics.add(value.place, fmt::format("[coupling] {} {} (as [{}], plug-in {}, declares it)",
                                                        reference_pressure, wrong, module.instance, module.plugin));
      module.parameters[i].is_given = given != nullptr;
    }
  }
}

} // namespace

bool read_coupling(CaseReader& reader, bool are_modules_known)
{
  const Node* coupling = reader.table("coupling");
  if (coupling == nullptr) {
    if (reader.root.table()->find("coupling") != nullptr) return false;
    if (are_modules_known && has_one_solver(reader.value)) {
      distribute_reference_pressure(reader, {}, nullptr);
      return true;
    }
    reader.diagnostics.add({}, fmt::format("there is no [coupling]; add the table with {}", example));
    return false;
  }
  const auto values = read_parameters(*coupling, {"[coupling]", ""}, detail::parameter_specs<CouplingOptions>(),
                                      {"interfaces"}, reader.diagnostics);
  reader.value.reference_pressure = std::get<double>(values[0].value);
  reader.value.displacement_limit = std::get<double>(values[1].value);
  const auto* given = coupling->table()->find(reference_pressure);
  if (given == nullptr || values[0].is_given) // a wrong value was reported already
    distribute_reference_pressure(reader, coupling->place, given == nullptr ? nullptr : &given->value);
  if (!read_interfaces(reader, *coupling, are_modules_known)) return false;
  if (reader.value.interfaces.empty() && reader.value.displacement_limit > 0.0) {
    reader.diagnostics.add(coupling->table()->find("displacement_limit")->value.place,
                           fmt::format("[coupling] displacement_limit watches the wet surface, and there is no "
                                       "interface: leave it out, or give {}",
                                       example));
    return false;
  }
  return true;
}

} // namespace mullion::config
