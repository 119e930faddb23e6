// Parameters are declared once, beside the struct that holds them; reading, range checks, `mullion modules` and
// the reference tables all come from that declaration:
//
//   struct Options {
//     double density = 2700.0;
//     static constexpr auto table()
//     {
//       return std::tuple{parameter("density", &Options::density, "kg/m^3", "mass per volume", above(0.0))};
//     }
//   };
//
// A trailing .changeable() lets `mullion set` change the parameter in a live run.
#pragma once

#include <mullion/sdk/abi.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <vector>

namespace mullion {

inline constexpr double unbounded = std::numeric_limits<double>::infinity();

/// The legal values of a parameter: an interval for numbers, a list for texts.
struct Range {
  double lower = -unbounded, upper = unbounded;
  bool excludes_lower = false, excludes_upper = false;
  std::array<const char*, 8> choices{};
  std::uint32_t n_choices = 0;
};

constexpr Range any() { return {}; }
constexpr Range at_least(double lower) { return {.lower = lower}; }
constexpr Range above(double lower) { return {.lower = lower, .excludes_lower = true}; }
constexpr Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
template <class... Texts> constexpr Range one_of(Texts... texts)
{
  static_assert(sizeof...(texts) <= 8);
  return {.choices = {texts...}, .n_choices = sizeof...(texts)};
}

template <class Owner, class T> struct Parameter {
  const char* name;
  T Owner::*member;
  const char* unit;
  const char* meaning;
  Range range;
  bool is_required;
  bool is_changeable = false;

  /// `mullion set` may change it in a live run: an object with the new value goes on from the windows as they are.
  /// Not for what sizes or fills windows in define (meshes, first states).
  [[nodiscard]] constexpr Parameter changeable() const
  {
    auto copy = *this;
    copy.is_changeable = true;
    return copy;
  }
};

/// A parameter with a default: the value that its member has in a fresh Options.
template <class Owner, class T>
constexpr Parameter<Owner, T> parameter(const char* name, T Owner::*member, const char* unit, const char* meaning,
                                        Range range = {})
{
  return {name, member, unit, meaning, range, false};
}

/// A parameter that the case must give.
template <class Owner, class T>
constexpr Parameter<Owner, T> required_parameter(const char* name, T Owner::*member, const char* unit,
                                                 const char* meaning, Range range = {})
{
  return {name, member, unit, meaning, range, true};
}

namespace detail {

template <class T> constexpr std::uint32_t parameter_type()
{
  if constexpr (std::is_same_v<T, bool>) return MULLION_BOOLEAN;
  else if constexpr (std::is_integral_v<T>) return MULLION_INTEGER;
  else if constexpr (std::is_floating_point_v<T>) return MULLION_REAL;
  else {
    static_assert(std::is_same_v<T, std::string>, "parameters are double, int, bool or std::string");
    return MULLION_TEXT;
  }
}

/// The declaration of Options as the flat C table; lives as long as the library.
template <class Options> const std::vector<mullion_parameter_spec>& parameter_specs()
{
  static const auto table = Options::table();
  static const Options defaults{};
  static const std::vector<mullion_parameter_spec> specs = [] {
    std::vector<mullion_parameter_spec> out;
    std::apply(
        [&](const auto&... entry) {
          [[maybe_unused]] const auto add = [&](const auto& p) { // unused without a parameter
            using T = std::remove_cvref_t<decltype(defaults.*(p.member))>;
            mullion_parameter_spec spec{};
            spec.name = p.name;
            spec.unit = p.unit;
            spec.meaning = p.meaning;
            spec.choices = p.range.choices.data();
            spec.n_choices = p.range.n_choices;
            spec.type = parameter_type<T>();
            spec.is_required = p.is_required ? 1 : 0;
            spec.excludes = (p.range.excludes_lower ? 1u : 0u) | (p.range.excludes_upper ? 2u : 0u);
            spec.is_changeable = p.is_changeable ? 1 : 0;
            spec.lower = p.range.lower;
            spec.upper = p.range.upper;
            if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) { // what the member can hold
              spec.lower = std::max(spec.lower, static_cast<double>(std::numeric_limits<T>::min()));
              spec.upper = std::min(spec.upper, static_cast<double>(std::numeric_limits<T>::max()));
            }
            spec.default_text = "";
            if constexpr (std::is_same_v<T, std::string>) spec.default_text = (defaults.*(p.member)).c_str();
            else if constexpr (std::is_floating_point_v<T>) spec.default_real = defaults.*(p.member);
            else spec.default_integer = static_cast<std::int64_t>(defaults.*(p.member));
            out.push_back(spec);
          };
          (add(entry), ...);
        },
        table);
    return out;
  }();
  return specs;
}

/// Options filled with values in the order of the declaration.
template <class Options> Options read_options(const mullion_value* values)
{
  Options options{};
  std::size_t i = 0;
  std::apply(
      [&](const auto&... entry) {
        [[maybe_unused]] const auto read = [&](const auto& p) {
          using T = std::remove_cvref_t<decltype(options.*(p.member))>;
          const mullion_value& value = values[i++];
          if constexpr (std::is_same_v<T, std::string>) options.*(p.member) = value.text;
          else if constexpr (std::is_floating_point_v<T>) options.*(p.member) = static_cast<T>(value.real);
          else if constexpr (std::is_same_v<T, bool>) options.*(p.member) = value.integer != 0;
          else options.*(p.member) = static_cast<T>(value.integer);
        };
        (read(entry), ...);
      },
      Options::table());
  return options;
}

} // namespace detail
} // namespace mullion
