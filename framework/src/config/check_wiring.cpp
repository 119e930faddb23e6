#include "config/check_wiring.hpp"

#include "config/suggestions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string_view>

namespace mullion::config {
namespace {

/// What two ends of a connection must agree on.
struct Port {
  std::uint32_t location, components, nature, scalar;
  std::string_view unit;
};

struct PortName {
  std::string instance, window, field;
};

bool split(const std::string& port, PortName& name)
{
  const auto first = port.find('.');
  const auto second = first == std::string::npos ? first : port.find('.', first + 1);
  if (second == std::string::npos || port.find('.', second + 1) != std::string::npos) return false;
  name = {port.substr(0, first), port.substr(first + 1, second - first - 1), port.substr(second + 1)};
  return true;
}

std::string location_name(std::uint32_t location)
{
  return location == MULLION_NODE ? "on nodes" : location == MULLION_ELEMENT ? "on elements" : "on the pane";
}
std::string components_name(std::uint32_t components)
{
  return components == 0 ? "vector" : components == 1 ? "1 component" : fmt::format("{} components", components);
}
std::string nature_name(std::uint32_t nature) { return nature == MULLION_INTENSIVE ? "intensive" : "extensive"; }

class Checker {
public:
  Checker(const Case& value, const Wiring& wiring, plugin::Catalogue& catalogue)
      : value_(value), wiring_(wiring), catalogue_(catalogue)
  {
  }

  std::vector<std::string> check()
  {
    for (const auto& connection : wiring_.connections) check_connection(connection);
    check_required_inputs();
    check_states();
    check_histories();
    return std::move(mistakes_);
  }

private:
  template <class... T> void report(fmt::format_string<T...> text, T&&... values)
  {
    mistakes_.push_back(fmt::format(text, std::forward<T>(values)...));
  }

  /// A declared field or input, or why there is none.
  struct Found {
    std::optional<Port> port;
    std::string problem;
  };

  [[nodiscard]] const ModuleCase* module_of(const std::string& instance, std::string& problem) const
  {
    std::vector<std::string> known;
    for (const auto& module : value_.modules) {
      if (module.instance == instance) return &module;
      known.push_back(module.instance);
    }
    problem = fmt::format("the case has no module '{}'{}", instance, suggestion(instance, known));
    return nullptr;
  }
  [[nodiscard]] const mullion_module& plugin_of(const ModuleCase& module)
  {
    return catalogue_.open(module.plugin).module();
  }

  /// @param table  the specs of a plug-in: its fields or its inputs
  /// @param verb   "has" or "receives"
  template <class TableOf, class PortOf>
  [[nodiscard]] Found find(const std::string& port, const char* verb, TableOf&& table, PortOf&& to_port)
  {
    PortName name;
    if (!split(port, name)) return {{}, fmt::format("'{}' is no port; a port is instance.window.field", port)};
    std::string problem;
    const auto* module = module_of(name.instance, problem);
    if (module == nullptr) return {{}, fmt::format("{}: {}", port, problem)};
    std::vector<std::string> known;
    for (const auto& spec : table(plugin_of(*module))) {
      if (spec.window == name.window && spec.name == name.field) return {to_port(spec), ""};
      known.push_back(fmt::format("{}.{}.{}", name.instance, spec.window, spec.name));
    }
    return {{}, fmt::format("{} {} no field {}{}", module->plugin, verb, port, suggestion(port, known))};
  }
  [[nodiscard]] Found find_input(const std::string& port)
  {
    return find(
        port, "receives", [](const mullion_module& plugin) { return std::span(plugin.inputs, plugin.n_inputs); },
        [](const mullion_input_spec& s) {
          return Port{s.location, s.components, s.nature, MULLION_F64, s.unit};
        });
  }
  [[nodiscard]] Found find_field(const std::string& port)
  {
    return find(
        port, "has", [](const mullion_module& plugin) { return std::span(plugin.fields, plugin.n_fields); },
        [](const mullion_field_spec& s) {
          return Port{s.location, s.components, s.nature, s.scalar, s.unit};
        });
  }

  void check_connection(const Connection& connection)
  {
    const auto to = find_input(connection.receiver);
    if (!to.port) report("{}", to.problem);
    const int n_connections = ++n_connections_[connection.receiver];
    if (to.port && n_connections == 2) // said once, however often it is connected
      report("{} is connected more than once; a received field has one source", connection.receiver);
    const bool is_bound = !connection.source.empty();
    check_levels(connection, is_bound);
    if (!is_bound) return;
    const auto from = find_field(connection.source);
    if (!from.port) report("{}", from.problem);
    if (to.port && from.port) check_agreement(connection, *from.port, *to.port);
  }

  void check_agreement(const Connection& connection, const Port& source, const Port& receiver)
  {
    const auto disagree = [&](const std::string& from, const std::string& to, const char* what) {
      report("{} [{}] cannot feed {} [{}]: {}", connection.source, from, connection.receiver, to, what);
    };
    if (source.unit != receiver.unit)
      disagree(std::string(source.unit), std::string(receiver.unit),
               "the units differ and a connection converts nothing; declare one unit in both plug-ins");
    if (source.location != receiver.location)
      disagree(location_name(source.location), location_name(receiver.location),
               "the values lie on different entities; put a transfer between them");
    const bool is_dimension_open = (source.components == 0) != (receiver.components == 0);
    if (source.components != receiver.components && !is_dimension_open)
      disagree(components_name(source.components), components_name(receiver.components),
               "the numbers of components differ");
    if (source.nature != receiver.nature)
      disagree(nature_name(source.nature), nature_name(receiver.nature),
               "an amount is no density; only a transfer turns one into the other");
    if (source.scalar != MULLION_F64)
      report("{} holds integers and cannot feed {}: received fields are real numbers", connection.source,
             connection.receiver);
  }

  void check_levels(const Connection& connection, bool is_bound)
  {
    const int needed = connection.policy == TimePolicy::quadratic ? 3 : connection.policy == TimePolicy::linear ? 2 : 1;
    if (is_bound) {
      const int present = 1 + committed_levels(connection.source);
      if (present < needed)
        report("{} reads {} with a policy that needs {} levels, and that window keeps {}; ask for {} committed levels "
               "with history()",
               connection.receiver, connection.source, needed, present, needed - 1);
      return;
    }
    if (connection.levels < 2 || connection.levels > MULLION_MAX_LEVELS)
      report("{} is stored with {} levels (the working one included); expected 2 to {}", connection.receiver,
             connection.levels, MULLION_MAX_LEVELS);
    else if (connection.levels < needed)
      report("{} is stored with {} levels, and its policy needs {}", connection.receiver, connection.levels, needed);
  }

  /// Of the window of a bound source.
  [[nodiscard]] int committed_levels(const std::string& port) const
  {
    PortName name;
    int levels = 1;
    if (!split(port, name)) return levels;
    for (const auto& request : wiring_.histories)
      if (request.window == name.instance + "." + name.window) levels = std::max(levels, request.committed_levels);
    return levels;
  }

  void check_required_inputs()
  {
    for (const auto& module : value_.modules) {
      const auto& plugin = plugin_of(module);
      for (const auto& input : std::span(plugin.inputs, plugin.n_inputs)) {
        const auto port = fmt::format("{}.{}.{}", module.instance, input.window, input.name);
        if (input.is_required != 0 && n_connections_.count(port) == 0)
          report("does not feed {} [{}], which {} cannot do without ({}); choose a scheme that does, or another module",
                 port, input.unit, module.plugin, input.meaning);
      }
    }
  }

  void check_states()
  {
    std::set<std::string> names;
    for (const auto& state : wiring_.states) {
      if (state.name.empty() || state.name.size() >= MULLION_MAX_NAME)
        report("the state field '{}' needs a name of 1 to {} bytes", state.name, MULLION_MAX_NAME - 1);
      if (!names.insert(state.name).second) report("declares the state field '{}' twice", state.name);
      if (state.name == "ledger")
        report("declares the state field 'ledger', which is Mullion's own; choose another name");
      if (state.like.empty() && state.size < 1)
        report("the state field '{}' has {} numbers; expected at least 1", state.name, state.size);
      if (!state.like.empty() && state.size < 1)
        report("the state field '{}' holds {} copies of {}; expected at least 1", state.name, state.size, state.like);
      if (state.like.empty() || find_input(state.like).port) continue;
      if (const auto like = find_field(state.like); !like.port)
        report("the state field '{}' is to look like a field that is not there: {}", state.name, like.problem);
    }
    const int levels = wiring_.committed_state_levels + 1;
    if (levels < 2 || levels > MULLION_MAX_LEVELS)
      report("driver/state has {} levels (the working one included); expected 2 to {}", levels, MULLION_MAX_LEVELS);
  }

  void check_histories()
  {
    for (const auto& request : wiring_.histories) {
      PortName name;
      std::string problem = "expected instance.window";
      const auto* module = split(request.window + ".", name) ? module_of(name.instance, problem) : nullptr;
      if (module == nullptr) {
        report("asks for the history of '{}': {}", request.window, problem);
        continue;
      }
      const auto& plugin = plugin_of(*module);
      std::vector<std::string> known;
      for (const auto& field : std::span(plugin.fields, plugin.n_fields)) known.emplace_back(field.window);
      if (std::find(known.begin(), known.end(), name.window) == known.end()) {
        known.erase(std::unique(known.begin(), known.end()), known.end());
        report("asks for the history of {}, and {} has no such window{}", request.window, module->plugin,
               suggestion(name.window, known));
      }
      const int levels = request.committed_levels + 1;
      if (levels < 2 || levels > MULLION_MAX_LEVELS)
        report("asks for {} levels of {} (the working one included); expected 2 to {}", levels, request.window,
               MULLION_MAX_LEVELS);
    }
  }

  const Case& value_;
  const Wiring& wiring_;
  plugin::Catalogue& catalogue_;
  std::map<std::string, int> n_connections_;
  std::vector<std::string> mistakes_;
};

} // namespace

void drop_declined_offers(Wiring& wiring, const Case& value, plugin::Catalogue& catalogue)
{
  const auto is_declared = [&](const std::string& port) {
    PortName name;
    if (!split(port, name)) return true; // check_wiring says what is wrong with it
    for (const auto& module : value.modules) {
      if (module.instance != name.instance) continue;
      const auto& plugin = catalogue.open(module.plugin).module();
      const std::span inputs(plugin.inputs, plugin.n_inputs);
      return std::any_of(inputs.begin(), inputs.end(),
                         [&](const auto& input) { return name.window == input.window && name.field == input.name; });
    }
    return true;
  };
  std::erase_if(wiring.connections, [&](const Connection& c) { return c.is_offer && !is_declared(c.receiver); });
}

std::vector<std::string> check_wiring(const Case& value, const Wiring& wiring, plugin::Catalogue& catalogue)
{
  return Checker(value, wiring, catalogue).check();
}

} // namespace mullion::config
