// The cells of the 1D fluid as the kernels see them: spans into memory that the caller owns (a
// window, a test's vectors), the values derived from them, and the check that they still describe a
// gas.
#pragma once

#include "gas.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace mullion::euler_1d {

/// Extensive cell values for an area of 1 m^2, and the mesh. Node i is the left node of cell i.
///
/// The lengths are state: the scheme advances them with the same stages as mass, momentum and
/// energy, which is why a uniform flow stays uniform (geometric conservation). They agree with the
/// node distances to round-off only.
struct State {
  std::span<double> mass;     ///< n_cells, rho L [kg]
  std::span<double> momentum; ///< n_cells, rho u L [kg m/s]
  std::span<double> energy;   ///< n_cells, rho E L [J]
  std::span<double> length;   ///< n_cells, L [m]
  std::span<double> node_x;   ///< n_cells + 1, along +x [m]

  [[nodiscard]] std::size_t n_cells() const { return mass.size(); }
};

/// The same, to read.
struct ConstState {
  std::span<const double> mass, momentum, energy, length, node_x;

  ConstState(const State& s) // NOLINT(google-explicit-constructor): a State is readable wherever
                             // this is asked for
      : mass(s.mass), momentum(s.momentum), energy(s.energy), length(s.length), node_x(s.node_x)
  {
  }
  ConstState(std::span<const double> mass_, std::span<const double> momentum_, std::span<const double> energy_,
             std::span<const double> length_, std::span<const double> node_x_)
      : mass(mass_), momentum(momentum_), energy(energy_), length(length_), node_x(node_x_)
  {
  }

  [[nodiscard]] std::size_t n_cells() const { return mass.size(); }
};

/// Cell means of one cell: rho = m / L, u = q / m, p = (gamma - 1) (e - q u / 2) / L.
inline Primitive cell_primitive(const ConstState& s, const Gas& gas, std::size_t cell)
{
  const double u = s.momentum[cell] / s.mass[cell];
  const double internal = s.energy[cell] - 0.5 * s.momentum[cell] * u;
  return {s.mass[cell] / s.length[cell], u, (gas.gamma - 1.0) * internal / s.length[cell]};
}

/// Fill a cell from its density, velocity and pressure; its length must be set already.
void set_cell(const State& state, const Gas& gas, std::size_t cell, const Primitive& value);

/// Output fields of all cells.
///
/// @param density, velocity, pressure  n_cells each [kg/m^3], [m/s], [Pa]
void cell_fields(const ConstState& state, const Gas& gas, std::span<double> density, std::span<double> velocity,
                 std::span<double> pressure);

/// Why a cell no longer holds a gas.
enum class Fault { non_finite, length, density, pressure };

/// Name of a fault for a message.
const char* to_string(Fault fault);

struct BadCell {
  std::size_t cell; ///< 0 at the left end
  Fault fault;
  double value; ///< what was found: the length, density or pressure, or the entry that is not finite
};

/// First cell (from the left) with an entry that is not finite, or a length, density or pressure
/// that is not positive; nothing if the state is sound. The outcome is foreseen, so it is a value
/// and no exception.
[[nodiscard]] std::optional<BadCell> find_bad_cell(const ConstState& state, const Gas& gas);

/// Sums over all cells, left to right [kg], [kg m/s], [J] for 1 m^2.
struct Totals {
  double mass = 0.0, momentum = 0.0, energy = 0.0;
};
[[nodiscard]] Totals totals(const ConstState& state);

} // namespace mullion::euler_1d
