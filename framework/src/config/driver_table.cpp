// [driver]: the coupling scheme, its parameters, and what it connects. The driver itself is asked (created and
// defined here, then thrown away): its connections may depend on its parameters.
#include "config/case_reader.hpp"
#include "config/check_wiring.hpp"
#include "config/parameter_table.hpp"
#include "run/time_plan.hpp"

#include <mullion/coupling/driver.hpp>

#include <fmt/format.h>

#include <memory>
#include <tuple>

namespace mullion::config {
namespace {

struct SchemeOptions {
  std::string scheme;
  static constexpr auto table()
  {
    return std::tuple{required_parameter("scheme", &SchemeOptions::scheme, "", "name of the driver's plug-in")};
  }
};

const char* policy_name(TimePolicy policy)
{
  switch (policy) {
  case TimePolicy::constant: return "constant";
  case TimePolicy::linear: return "linear";
  case TimePolicy::quadratic: return "quadratic";
  }
  return "unknown";
}

/// For a scheme that can't shorten the last step: do whole steps fit into the run?
void check_constant_step(CaseReader& reader)
{
  try {
    static_cast<void>(run::TimePlan(reader.value, true));
  } catch (const Error& error) {
    reader.diagnostics.add(reader.table("run")->table()->find("dt")->value.place, error.what());
  }
}

} // namespace

bool read_driver(CaseReader& reader)
{
  auto& diagnostics = reader.diagnostics;
  const Node* node = reader.table("driver");
  if (node == nullptr) {
    if (reader.root.table()->find("driver") == nullptr)
      diagnostics.add({}, "there is no [driver]; add the table with the coupling scheme: scheme = \"…\"");
    return false;
  }
  const auto n_before = diagnostics.size();
  const auto* scheme = node->table()->find("scheme");
  const auto* name = scheme == nullptr ? nullptr : scheme->value.text();
  const plugin::Library* library = nullptr;
  if (name != nullptr) library = open_plugin(reader, *name, scheme->value.place, "[driver] scheme");
  if (library != nullptr && !library->is_driver()) {
    diagnostics.add(scheme->value.place,
                    fmt::format("[driver] scheme = \"{0}\" is no driver but a {1} module; name a driver here and the "
                                "module in a table of its own: module = \"{0}\"",
                                *name, library->header().kind));
    library = nullptr;
  }
  auto specs = detail::parameter_specs<SchemeOptions>();
  std::vector<std::string> other_keys;
  if (library != nullptr) specs.insert(specs.end(), library->parameters().begin(), library->parameters().end());
  else
    for (const auto& entry : node->table()->entries) other_keys.push_back(entry.key);

  const auto values =
      read_parameters(*node, {"[driver]", library == nullptr ? "" : *name}, specs, other_keys, diagnostics);
  if (library == nullptr) return false;
  reader.value.scheme = *name;
  reader.value.scheme_path = library->path();
  reader.value.driver_parameters.assign(values.begin() + 1, values.end());
  return diagnostics.size() == n_before;
}

void check_scheme(CaseReader& reader, bool are_times_sound)
{
  Case& value = reader.value;
  const Node& table = *reader.table("driver");
  const Place& scheme = table.table()->find("scheme")->value.place;
  const auto report = [&](const Place& place, const std::string& message) {
    reader.diagnostics.add(place, fmt::format("driver {}: {}", value.scheme, message));
  };

  std::unique_ptr<Driver> driver;
  try {
    const auto values = to_values(value.driver_parameters);
    driver.reset(reader.catalogue.open(value.scheme).driver().create(values.data()));
  } catch (const std::exception& error) {
    return report(table.place, error.what());
  }

  std::vector<InterfacePair> interfaces;
  for (const auto& pair : value.interfaces) interfaces.push_back({pair.fluid, pair.structure});
  std::vector<std::pair<std::string, std::string>> instances;
  for (const auto& module : value.modules) instances.emplace_back(module.kind, module.instance);
  Wiring wiring(std::move(interfaces), std::move(instances));
  try {
    driver->define(wiring);
  } catch (const std::exception& error) {
    return report(scheme, error.what());
  }
  drop_declined_offers(wiring, value, reader.catalogue);
  for (const auto& mistake : check_wiring(value, wiring, reader.catalogue)) report(scheme, mistake);
  for (const auto& connection : wiring.connections)
    value.connections.push_back({connection.receiver, connection.source, policy_name(connection.policy)});
  if (wiring.needs_constant_step && are_times_sound) check_constant_step(reader);
  if (wiring.needs_constant_step && value.on_divergence == "halve_dt")
    reader.diagnostics.add(reader.table("run")->table()->find("on_divergence")->value.place,
                           fmt::format("[run] on_divergence = \"halve_dt\": driver {} cannot take steps of varying "
                                       "size; choose \"stop\", or another scheme",
                                       value.scheme));
}

} // namespace mullion::config
