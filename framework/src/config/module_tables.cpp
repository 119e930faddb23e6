// The tables of a case that name modules: which plug-in, in which process, with which parameters.
#include "config/case_reader.hpp"
#include "config/parameter_table.hpp"
#include "config/suggestions.hpp"
#include "shm/control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace mullion::config {
namespace {

constexpr const char* kinds[] = {"fluid", "structure", "mesh_motion", "transfer"};

/// What every instance has, whatever its plug-in.
struct InstanceOptions {
  std::string module;
  bool process = false;
  static constexpr auto table()
  {
    return std::tuple{required_parameter("module", &InstanceOptions::module, "", "name of the plug-in"),
                      parameter("process", &InstanceOptions::process, "", "runs in a process of its own")};
  }
};

std::size_t rank_of_kind(std::string_view kind)
{
  return static_cast<std::size_t>(std::find(std::begin(kinds), std::end(kinds), kind) - std::begin(kinds));
}

bool is_framework_table(const std::string& name)
{
  return std::find(framework_tables.begin(), framework_tables.end(), name) != framework_tables.end();
}

/// Names become parts of ports (instance.window.field) and of messages.
bool is_instance_name(const std::string& name)
{
  const auto is_legal = [](char c) {
    return ('a' <= c && c <= 'z') || ('A' <= c && c <= 'Z') || ('0' <= c && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && name.size() < MULLION_MAX_NAME && std::all_of(name.begin(), name.end(), is_legal);
}

/// Is it a table that can be an instance? Reports what isn't.
bool is_instance(CaseReader& reader, const Entry& entry)
{
  auto& diagnostics = reader.diagnostics;
  if (entry.value.table() == nullptr) {
    const auto nearest = nearest_name(entry.key, framework_tables);
    if (const auto* list = entry.value.list(); list != nullptr && !list->empty() && (*list)[0].table() != nullptr)
      diagnostics.add(entry.place,
                      fmt::format("[[{0}]] is a list of tables; {1}", entry.key,
                                  nearest == "expect" ? "did you mean [[expect]]?"
                                                      : "a module is one table: write [" + entry.key + "]"));
    else
      diagnostics.add(entry.place, fmt::format("'{}' stands outside of every table; put it under the table that it "
                                               "belongs to ([run], [coupling], [driver], [output] or a module's)",
                                               entry.key));
    return false;
  }
  if (!is_instance_name(entry.key)) {
    diagnostics.add(entry.place, fmt::format("[{}] cannot be a module's name; expected 1 to {} letters, digits, '_' or "
                                             "'-'",
                                             entry.key, MULLION_MAX_NAME - 1));
    return false;
  }
  if (entry.value.table()->find("module") == nullptr) {
    const auto nearest = nearest_name(entry.key, framework_tables);
    diagnostics.add(entry.value.place,
                    nearest.empty()
                        ? fmt::format("[{}] has no 'module'; every table but [run], [coupling], [driver], [output] and "
                                      "[[expect]] is a module and names its plug-in: module = \"…\"",
                                      entry.key)
                        : fmt::format("[{}] is no table of a case, and without 'module' it is no module; did you mean "
                                      "[{}]?",
                                      entry.key, nearest));
    return false;
  }
  return true;
}

/// The kind of the instance's plug-in if it is a module, with diagnostics otherwise.
const plugin::Library* module_plugin(CaseReader& reader, const std::string& instance, const std::string& name,
                                     const Place& place)
{
  const auto* library = open_plugin(reader, name, place, fmt::format("[{}] module", instance));
  if (library == nullptr) return nullptr;
  if (library->is_driver()) {
    reader.diagnostics.add(place, fmt::format("[{}] module = \"{}\" is a driver; a driver is named by scheme in "
                                              "[driver], a module has one of the kinds {}",
                                              instance, name, fmt::join(kinds, ", ")));
    return nullptr;
  }
  if (rank_of_kind(library->header().kind) == std::size(kinds)) {
    reader.diagnostics.add(place, fmt::format("[{}] module = \"{}\" is of the unknown kind '{}'; known are {}",
                                              instance, name, library->header().kind, fmt::join(kinds, ", ")));
    return nullptr;
  }
  return library;
}

/// One instance; false if nothing can be built on it.
bool read_instance(CaseReader& reader, const Entry& entry)
{
  auto& diagnostics = reader.diagnostics;
  Node node = entry.value;
  const Node module_value = node.table()->find("module")->value;
  const auto* name = module_value.text();
  const auto* library = name == nullptr ? nullptr : module_plugin(reader, entry.key, *name, module_value.place);

  auto specs = detail::parameter_specs<InstanceOptions>();
  const auto n_own = static_cast<std::ptrdiff_t>(specs.size());
  std::vector<std::string> other_keys;
  if (library != nullptr) specs.insert(specs.end(), library->parameters().begin(), library->parameters().end());
  else // what else is legal here cannot be known
    for (const auto& other : node.table()->entries) other_keys.push_back(other.key);

  for (auto& spec : specs) {
    if (spec.name != reference_pressure) continue;
    spec.is_required = 0; // [coupling] gives it
    if (const auto* misplaced = node.table()->find(reference_pressure)) {
      diagnostics.add(misplaced->place, fmt::format("[{}] {} belongs in [coupling]: one value for all modules; move it "
                                                    "there",
                                                    entry.key, reference_pressure));
      std::erase_if(node.table()->entries, [](const Entry& e) { return e.key == reference_pressure; });
    }
  }
  const TableOwner owner{fmt::format("[{}]", entry.key), library == nullptr ? "" : *name};
  const auto values = read_parameters(node, owner, specs, other_keys, diagnostics);
  if (library == nullptr) return false;
  ModuleCase instance{entry.key, library->header().kind, *name, library->header().version, library->path(), false, {}};
  const bool wants_process = std::get<bool>(values[1].value);
  instance.is_process = reader.options.all_processes || (wants_process && !reader.options.all_inline);
  instance.parameters.assign(values.begin() + n_own, values.end());

  const auto& modules = reader.value.modules;
  const auto same_kind =
      std::find_if(modules.begin(), modules.end(), [&](const ModuleCase& m) { return m.kind == instance.kind; });
  if (same_kind != modules.end()) {
    diagnostics.add(module_value.place,
                    fmt::format("[{}] is a second {} beside [{}]; a case has one of each kind today: remove one of the "
                                "two tables",
                                entry.key, instance.kind, same_kind->instance));
    return false;
  }
  reader.value.modules.push_back(std::move(instance));
  return true;
}

} // namespace

const plugin::Library* open_plugin(CaseReader& reader, const std::string& name, const Place& place,
                                   const std::string& label)
{
  try {
    return &reader.catalogue.open(name);
  } catch (const std::exception& error) {
    reader.diagnostics.add(place, fmt::format("{} = \"{}\": {}", label, name, error.what()));
    return nullptr;
  }
}

bool read_modules(CaseReader& reader)
{
  bool is_sound = true;
  std::size_t n_modules = 0;
  for (const auto& entry : reader.root.table()->entries) {
    if (is_framework_table(entry.key)) continue;
    if (!is_instance(reader, entry)) {
      is_sound = false;
      continue;
    }
    if (++n_modules == shm::max_modules + 1)
      reader.diagnostics.add(entry.value.place, fmt::format("[{}] is module number {}; a run has at most {}", entry.key,
                                                            n_modules, shm::max_modules));
    is_sound = read_instance(reader, entry) && is_sound;
  }
  std::stable_sort(reader.value.modules.begin(), reader.value.modules.end(),
                   [](const ModuleCase& a, const ModuleCase& b) {
                     return std::tuple(rank_of_kind(a.kind), a.instance) < std::tuple(rank_of_kind(b.kind), b.instance);
                   });
  return is_sound;
}

} // namespace mullion::config
