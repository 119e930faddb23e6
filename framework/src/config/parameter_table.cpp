#include "config/parameter_table.hpp"

#include "config/suggestions.hpp"
#include "config/toml_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace mullion::config {
namespace {

std::string number(double value) { return fmt::format("{}", value); }

/// Bounds that only say what an int can hold are no news.
bool is_bound(const mullion_parameter_spec& spec, double bound)
{
  return std::isfinite(bound) && (spec.type != MULLION_INTEGER || std::abs(bound) < 2147483647.0);
}

std::string interval(const mullion_parameter_spec& spec)
{
  const bool has_lower = is_bound(spec, spec.lower), has_upper = is_bound(spec, spec.upper);
  const bool excludes_lower = (spec.excludes & 1u) != 0, excludes_upper = (spec.excludes & 2u) != 0;
  if (has_lower && has_upper)
    return fmt::format("in {}{}, {}{}", excludes_lower ? '(' : '[', number(spec.lower), number(spec.upper),
                       excludes_upper ? ')' : ']');
  if (has_lower) return fmt::format("{} {}", excludes_lower ? ">" : ">=", number(spec.lower));
  if (has_upper) return fmt::format("{} {}", excludes_upper ? "<" : "<=", number(spec.upper));
  return "";
}

bool is_in_range(const mullion_parameter_spec& spec, double value)
{
  const bool is_above = (spec.excludes & 1u) != 0 ? spec.lower < value : spec.lower <= value;
  const bool is_below = (spec.excludes & 2u) != 0 ? value < spec.upper : value <= spec.upper;
  return is_above && is_below;
}

bool is_choice(const mullion_parameter_spec& spec, const std::string& text)
{
  return spec.n_choices == 0 ||
         std::any_of(spec.choices, spec.choices + spec.n_choices, [&](const char* c) { return text == c; });
}

std::string wish(const mullion_parameter_spec& spec)
{
  return fmt::format("expected {}: {}", expected(spec), spec.meaning);
}

} // namespace

std::string expected(const mullion_parameter_spec& spec)
{
  const std::string_view unit = spec.unit == nullptr ? "" : spec.unit;
  const auto with_range = [&](const char* what) {
    const auto limits = interval(spec);
    return fmt::format("{}{}{}{}", what, limits.empty() ? "" : " ", limits,
                       unit.empty() || unit == "1" ? "" : fmt::format(" [{}]", unit));
  };
  switch (spec.type) {
  case MULLION_REAL: return with_range("a number");
  case MULLION_INTEGER: return with_range("an integer");
  case MULLION_BOOLEAN: return "true or false";
  default: break;
  }
  if (spec.n_choices == 0) return "a text";
  std::string out;
  for (std::uint32_t i = 0; i < spec.n_choices; ++i)
    out += fmt::format("{}\"{}\"", i == 0 ? "" : i + 1 == spec.n_choices ? " or " : ", ", spec.choices[i]);
  return out;
}

std::string range_text(const mullion_parameter_spec& spec)
{
  if (spec.type == MULLION_REAL || spec.type == MULLION_INTEGER) return interval(spec);
  return fmt::format("{}", fmt::join(spec.choices, spec.choices + spec.n_choices, " | "));
}

ParameterValue default_value(const mullion_parameter_spec& spec)
{
  switch (spec.type) {
  case MULLION_REAL: return {spec.name, spec.default_real, false};
  case MULLION_INTEGER: return {spec.name, spec.default_integer, false};
  case MULLION_BOOLEAN: return {spec.name, spec.default_integer != 0, false};
  default: return {spec.name, std::string(spec.default_text == nullptr ? "" : spec.default_text), false};
  }
}

std::string take_value(const Node& node, const mullion_parameter_spec& spec, ParameterValue& out)
{
  const auto wrong = [&](const char* what) { return fmt::format("= {} {}; {}", write_value(node), what, wish(spec)); };
  const auto wrong_type = [&] { return fmt::format("= {}; {}", describe(node), wish(spec)); };
  const auto* integer = std::get_if<std::int64_t>(&node.value);

  if (spec.type == MULLION_REAL) {
    const auto* real = std::get_if<double>(&node.value);
    if (real == nullptr && integer == nullptr) return wrong_type();
    const double value = real != nullptr ? *real : static_cast<double>(*integer);
    if (!std::isfinite(value)) return wrong("is not finite");
    if (!is_in_range(spec, value)) return wrong("is out of range");
    out.value = value;
  } else if (spec.type == MULLION_INTEGER) {
    if (integer == nullptr) return wrong_type();
    if (!is_in_range(spec, static_cast<double>(*integer)))
      return wrong(std::abs(static_cast<double>(*integer)) > 2147483647.0 ? "does not fit into 32 bits"
                                                                          : "is out of range");
    out.value = *integer;
  } else if (spec.type == MULLION_BOOLEAN) {
    if (node.boolean() == nullptr) return wrong_type();
    out.value = *node.boolean();
  } else {
    if (node.text() == nullptr) return wrong_type();
    if (!is_choice(spec, *node.text())) return wrong("is no choice");
    if (node.text()->find('\0') != std::string::npos) return wrong("has a zero byte in it");
    out.value = *node.text();
  }
  out.is_given = true;
  return "";
}

std::vector<ParameterValue> read_parameters(const Node& node, const TableOwner& owner,
                                            std::span<const mullion_parameter_spec> specs,
                                            const std::vector<std::string>& other_keys, Diagnostics& diagnostics)
{
  const Table& table = *node.table();
  std::vector<ParameterValue> values;
  std::vector<std::string> known = other_keys;
  for (const auto& spec : specs) {
    known.emplace_back(spec.name);
    auto& value = values.emplace_back(default_value(spec));
    if (const auto* entry = table.find(spec.name); entry != nullptr) {
      if (const auto wrong = take_value(entry->value, spec, value); !wrong.empty())
        diagnostics.add(entry->value.place, fmt::format("{} {} {}", owner.label, spec.name, wrong));
    } else if (spec.is_required != 0) {
      diagnostics.add(node.place, fmt::format("{} has no '{}'; {}", owner.label, spec.name, wish(spec)));
    }
  }
  for (const auto& entry : table.entries)
    if (std::find(known.begin(), known.end(), entry.key) == known.end())
      diagnostics.add(entry.place, fmt::format("{} knows no key '{}'{}{}", owner.label, entry.key,
                                               owner.name.empty() ? "" : fmt::format(" (plug-in {})", owner.name),
                                               suggestion(entry.key, known)));
  return values;
}

std::vector<mullion_value> to_values(const std::vector<ParameterValue>& parameters)
{
  std::vector<mullion_value> values;
  for (const auto& parameter : parameters) {
    mullion_value value{0.0, 0, ""};
    if (const auto* real = std::get_if<double>(&parameter.value)) value.real = *real;
    else if (const auto* integer = std::get_if<std::int64_t>(&parameter.value)) value.integer = *integer;
    else if (const auto* boolean = std::get_if<bool>(&parameter.value)) value.integer = *boolean ? 1 : 0;
    else value.text = std::get<std::string>(parameter.value).c_str();
    values.push_back(value);
  }
  return values;
}

} // namespace mullion::config
