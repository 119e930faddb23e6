// Conversions between extensive cell values and point values, and the soundness check.
#include "state.hpp"

#include <cmath>

namespace mullion::euler_1d {

void set_cell(const State& state, const Gas& gas, std::size_t cell, const Primitive& value)
{
  const double length = state.length[cell];
  state.mass[cell] = value.density * length;
  state.momentum[cell] = value.density * value.velocity * length;
  state.energy[cell] = energy_density(gas, value) * length;
}

void cell_fields(const ConstState& state, const Gas& gas, std::span<double> density, std::span<double> velocity,
                 std::span<double> pressure)
{
  for (std::size_t i = 0; i < state.n_cells(); ++i) {
    const Primitive q = cell_primitive(state, gas, i);
    density[i] = q.density;
    velocity[i] = q.velocity;
    pressure[i] = q.pressure;
  }
}

const char* to_string(Fault fault)
{
  switch (fault) {
  case Fault::non_finite: return "non-finite value";
  case Fault::length: return "length not positive";
  case Fault::density: return "density not positive";
  case Fault::pressure: return "pressure not positive";
  }
  return "unknown fault";
}

std::optional<BadCell> find_bad_cell(const ConstState& state, const Gas& gas)
{
  for (std::size_t i = 0; i < state.n_cells(); ++i) {
    for (const double entry :
         {state.mass[i], state.momentum[i], state.energy[i], state.length[i], state.node_x[i], state.node_x[i + 1]})
      if (!std::isfinite(entry)) return BadCell{i, Fault::non_finite, entry};
    if (!(state.length[i] > 0.0)) return BadCell{i, Fault::length, state.length[i]};
    const Primitive q = cell_primitive(state, gas, i);
    if (!(q.density > 0.0)) return BadCell{i, Fault::density, q.density};
    if (!(q.pressure > 0.0)) // also when an overflow made it not-a-number
      return BadCell{i, Fault::pressure, q.pressure};
  }
  return std::nullopt;
}

Totals totals(const ConstState& state)
{
  Totals sum;
  for (std::size_t i = 0; i < state.n_cells(); ++i) {
    sum.mass += state.mass[i];
    sum.momentum += state.momentum[i];
    sum.energy += state.energy[i];
  }
  return sum;
}

} // namespace mullion::euler_1d
