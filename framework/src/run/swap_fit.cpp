#include "run/swap_fit.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <span>
#include <vector>

namespace mullion::run {
namespace {

constexpr const char* locations[] = {"node", "element", "pane"};
constexpr const char* roles[] = {"state", "output", "fixed"};
constexpr const char* natures[] = {"intensive", "extensive"};
constexpr const char* carries[] = {"copied", "overwritten"};
constexpr const char* scalars[] = {"real", "integer"};

template <std::size_t N> std::string word(const char* const (&words)[N], std::uint32_t value)
{
  return value < N ? words[value] : fmt::format("unknown ({})", value);
}

/// What two parties must agree on about a field, in words that a message can show.
std::vector<std::string> traits(const char* unit, std::uint32_t location, std::uint32_t components,
                                std::uint32_t nature)
{
  return {fmt::format("unit {}", unit), fmt::format("on {}", word(locations, location)),
          fmt::format("{} component{}", components, components == 1 ? "" : "s"), word(natures, nature)};
}

void compare(const std::string& name, const std::vector<std::string>& there, const std::vector<std::string>& wanted,
             std::vector<std::string>& out)
{
  for (std::size_t i = 0; i < there.size(); ++i)
    if (there[i] != wanted[i])
      out.push_back(fmt::format("{} is '{}', the candidate has '{}'", name, there[i], wanted[i]));
}

const mullion_field_spec* find_spec(std::span<const mullion_field_spec> specs, const std::string& window,
                                    const char* name)
{
  for (const auto& spec : specs)
    if (window == spec.window && std::strcmp(spec.name, name) == 0) return &spec;
  return nullptr;
}

const mullion_input_spec* find_spec(std::span<const mullion_input_spec> specs, const std::string& window,
                                    const char* name)
{
  for (const auto& spec : specs)
    if (window == spec.window && std::strcmp(spec.name, name) == 0) return &spec;
  return nullptr;
}

/// An own window: the fields there and those declared are the same ones.
void compare_window(const mullion_module& candidate, const std::string& window, const shm::WindowView& view,
                    std::vector<std::string>& out)
{
  const std::span specs(candidate.fields, candidate.n_fields);
  const auto dimension = view.header().dimension;
  for (const auto& field : view.fields()) {
    if (field.pane != 0) continue; // every pane has the same fields
    const auto name = fmt::format("{}.{}", window, field.name);
    const auto* spec = find_spec(specs, window, field.name);
    if (spec == nullptr) {
      out.push_back(fmt::format("{} is there, the candidate does not declare it", name));
      continue;
    }
    auto there = traits(field.unit, field.location, field.components, field.nature);
    auto wanted =
        traits(spec->unit, spec->location, spec->components == 0 ? dimension : spec->components, spec->nature);
    for (auto [list, role, carry, scalar] : {std::tuple{&there, field.role, field.carry, field.scalar},
                                             std::tuple{&wanted, spec->role, spec->carry, spec->scalar}}) {
      list->push_back(word(roles, role));
      list->push_back(word(carries, carry));
      list->push_back(word(scalars, scalar));
    }
    compare(name, there, wanted, out);
  }
  for (const auto& spec : specs)
    if (window == spec.window && view.find_field(0, spec.name) < 0)
      out.push_back(fmt::format("the candidate declares {}.{}, which is not there", window, spec.name));
}

/// A companion: what the driver puts there is what the candidate receives.
void compare_companion(const mullion_module& candidate, const std::string& window, const shm::WindowView& view,
                       std::vector<std::string>& out)
{
  for (const auto& field : view.fields()) {
    if (field.pane != 0) continue;
    const auto name = fmt::format("{}.{}", window, field.name);
    const auto* spec = find_spec(std::span(candidate.inputs, candidate.n_inputs), window, field.name);
    if (spec == nullptr) {
      out.push_back(fmt::format("the driver sends {}, which the candidate does not receive", name));
      continue;
    }
    const auto components = spec->components == 0 ? view.header().dimension : spec->components;
    compare(name + " (received)", traits(field.unit, field.location, field.components, field.nature),
            traits(spec->unit, spec->location, components, spec->nature), out);
  }
}

} // namespace

std::string misfit(const mullion_module& candidate, std::uint32_t module, shm::WindowMap& windows)
{
  const auto& control = windows.control();
  const auto prefix = std::string(control.modules[module].name) + "/";
  std::vector<std::string> out;
  const auto name_of = [&](std::uint32_t w) { return std::string(control.windows[w].name).substr(prefix.size()); };
  for (std::uint32_t w = 0; w < control.n_windows; ++w) {
    const auto& record = control.windows[w];
    if (record.module != module) continue;
    const auto name = name_of(w);
    if (record.owner == shm::Owner::module) compare_window(candidate, name, windows.view(w), out);
    else compare_companion(candidate, name.substr(0, name.size() - std::strlen(".in")), windows.view(w), out);
  }
  for (const auto& spec : std::span(candidate.fields, candidate.n_fields))
    if (control.find_window(prefix + spec.window) == shm::no_window)
      out.push_back(fmt::format("the candidate has a window '{}', which is not there", spec.window));
  for (const auto& spec : std::span(candidate.inputs, candidate.n_inputs)) {
    const auto companion = control.find_window(prefix + spec.window + ".in");
    const bool is_fed = companion != shm::no_window && windows.view(companion).find_field(0, spec.name) >= 0;
    if (spec.is_required != 0 && !is_fed)
      out.push_back(fmt::format("the candidate needs {}.{}, which the driver does not send", spec.window, spec.name));
  }
  return fmt::format("{}", fmt::join(out, "; "));
}

} // namespace mullion::run
