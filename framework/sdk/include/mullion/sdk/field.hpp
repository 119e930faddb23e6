// How a module declares its fields: once, as a table, from which Mullion makes the windows, checks the
// connections and prints the reference. A declaration knows no sizes; panes bring those in `define`.
#pragma once

#include <mullion/sdk/abi.h>

#include <cstdint>
#include <string>

namespace mullion {

using Index = std::int32_t; ///< number of a node or an element within a pane

enum class Location : std::uint32_t { node = MULLION_NODE, element = MULLION_ELEMENT, pane = MULLION_PANE };
enum class Role : std::uint32_t { state = MULLION_STATE, output = MULLION_OUTPUT, fixed = MULLION_FIXED };
enum class Nature : std::uint32_t { intensive = MULLION_INTENSIVE, extensive = MULLION_EXTENSIVE };
enum class Carry : std::uint32_t { copy = MULLION_COPY, overwrite = MULLION_OVERWRITE };
enum class TimePolicy : std::uint32_t {
  constant = MULLION_CONSTANT, ///< the newest value, whatever the time
  linear = MULLION_LINEAR,     ///< between the two newest stamped levels
  quadratic = MULLION_QUADRATIC
};

inline constexpr std::uint32_t vector = 0; ///< as many components as the window has dimensions
inline constexpr std::uint32_t scalar = 1;

/// One field that a module owns. Use state(), output() or fixed() to make one.
struct FieldSpec {
  std::string window, name;
  Location location;
  std::uint32_t components; ///< 0: the window's dimension
  std::string unit, meaning;
  Role role;
  Nature nature = Nature::intensive;
  Carry carry = Carry::copy;
  std::uint32_t scalar_type = MULLION_F64;

  /// An amount (a load, a mass) rather than a density; decides which transfers are legal.
  FieldSpec extensive() &&
  {
    nature = Nature::extensive;
    return std::move(*this);
  }
  /// A state that every step writes whole: it is not copied when the step is armed.
  FieldSpec overwritten() &&
  {
    carry = Carry::overwrite;
    return std::move(*this);
  }
  /// 32-bit integers; fixed fields only.
  FieldSpec integer() &&
  {
    scalar_type = MULLION_I32;
    return std::move(*this);
  }
};

/// State: carried from step to step; level 0 starts as a copy of the last committed level.
inline FieldSpec state(std::string window, std::string name, Location location, std::uint32_t components,
                       std::string unit, std::string meaning)
{
  return {std::move(window), std::move(name), location, components, std::move(unit), std::move(meaning), Role::state};
}

/// Output: computed afresh by every step; on arming it holds garbage (NaN under --replay).
/// An output on the pane (one value) becomes a column of history.csv.
inline FieldSpec output(std::string window, std::string name, Location location, std::uint32_t components,
                        std::string unit, std::string meaning)
{
  FieldSpec spec{std::move(window), std::move(name),    location,    components,
                 std::move(unit),   std::move(meaning), Role::output};
  spec.carry = Carry::overwrite;
  return spec;
}

/// Fixed: written once in define (reference data), read-only ever after; stored once, not per level.
inline FieldSpec fixed(std::string window, std::string name, Location location, std::uint32_t components,
                       std::string unit, std::string meaning)
{
  return {std::move(window), std::move(name), location, components, std::move(unit), std::move(meaning), Role::fixed};
}

/// One field that a module receives, on the entities of its own window `window`.
struct InputSpec {
  std::string window, name;
  Location location;
  std::uint32_t components;
  std::string unit, meaning;
  Nature nature = Nature::intensive;
  bool is_required = true;

  InputSpec extensive() &&
  {
    nature = Nature::extensive;
    return std::move(*this);
  }
  /// The module has a default for it: a driver may leave it unconnected.
  InputSpec optional() &&
  {
    is_required = false;
    return std::move(*this);
  }
};

inline InputSpec receive(std::string window, std::string name, Location location, std::uint32_t components,
                         std::string unit, std::string meaning)
{
  return {std::move(window), std::move(name), location, components, std::move(unit), std::move(meaning)};
}

} // namespace mullion
