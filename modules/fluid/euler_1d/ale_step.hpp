// One time step of the 1D Euler equations on a moving mesh: finite volumes, MUSCL, HLLC, Heun. It
// neither chooses the mesh motion nor the step size, and allocates nothing.
#pragma once

#include "gas.hpp"
#include "left_end.hpp"
#include "reconstruction.hpp"
#include "state.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace mullion::euler_1d {

struct AleOptions {
  Gas gas{};
  Limiter limiter = Limiter::none;
  LeftEnd left_end = LeftEnd::closed;
  Reference reference{}; ///< the gas outside, read only if left_end is open
};

/// Scratch memory of advance(), sized once. It holds nothing from one step to the next.
class Workspace {
public:
  explicit Workspace(std::size_t n_cells);

  std::vector<double> mass, momentum, energy, length; ///< n_cells: stage values
  std::vector<Primitive> cells, left, right;          ///< n_cells: means and their face values
  std::vector<Flux> flux_begin, flux_end;             ///< n_cells + 1: of the two stages
};

/// Time integrals at the right wall as the Runge-Kutta scheme takes them, for 1 m^2: sums over the
/// stages of dt b_j (.). They add up over substeps.
struct WallIntegrals {
  double impulse = 0.0;      ///< of p_w [Pa s]; over the elapsed time it is the mean pressure
  double work = 0.0;         ///< of p_w w [J/m^2], positive when the fluid does work: exactly its energy loss there
  double swept_volume = 0.0; ///< of w [m]; work - p_ref * swept_volume is the work against p_ref

  WallIntegrals& operator+=(const WallIntegrals& other)
  {
    impulse += other.impulse;
    work += other.work;
    swept_volume += other.swept_volume;
    return *this;
  }
};

/// Node velocities w_i = xi_i w of a mesh that moves linearly from a fixed left end to the wall,
/// xi_i = i / n_cells.
void linear_node_velocities(double wall_velocity, std::span<double> node_velocity);

/// Advance the state by one Heun step on the moving mesh.
///
///     U1      = U + dt R(U, w_begin)
///     U^{n+1} = U + dt/2 (R(U, w_begin) + R(U1, w_end)),   R_i = -(H_{i+1} - H_i),  H = F(U*) - w
///     U*
///
/// for U = (mass, momentum, energy) and, with dL_i/dt = w_{i+1} - w_i and dx_i/dt = w_i, for the
/// lengths and the nodes too, so the discrete geometric conservation law holds to round-off. Inner
/// faces are HLLC on MUSCL values, the left end is closed or open, the right end is the moving
/// wall. The problem is the fluid of Jaiman et al. 2011, section 6; the discretisation is a
/// standard one of our choice.
///
/// @param state              n_cells cells, n_cells + 1 nodes; advanced in place
/// @param w_begin, w_end     n_cells + 1 node velocities at the two stages [m/s]; equal for a
/// constant profile
/// @param dt                 step [s]; stable up to a Courant number of about 1
/// @param workspace          made for the same n_cells
/// @return                   integrals over this step at the right wall
/// @pre                      n_cells >= 2 and a sound state (find_bad_cell()); an unsound one gives
/// an unsound result
WallIntegrals advance(const State& state, std::span<const double> w_begin, std::span<const double> w_end, double dt,
                      const AleOptions& options, Workspace& workspace);

} // namespace mullion::euler_1d
