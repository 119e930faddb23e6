// Heun's method for the finite volume fluxes on a moving mesh.
#include "ale_step.hpp"

#include "riemann.hpp"
#include "wall.hpp"

namespace mullion::euler_1d {

namespace {

// All face fluxes of a state; returns the pressure on the right wall.
double face_fluxes(const ConstState& state, std::span<const double> w, const AleOptions& options, Workspace& work,
                   std::span<Flux> flux)
{
  const Gas& gas = options.gas;
  const std::size_t n = state.n_cells();
  for (std::size_t i = 0; i < n; ++i) work.cells[i] = cell_primitive(state, gas, i);
  reconstruct(work.cells, state.length, options.limiter, work.left, work.right);

  flux[0] = left_end_flux(gas, options.left_end, options.reference, work.left[0], w[0]);
  for (std::size_t i = 1; i < n; ++i) flux[i] = hllc_flux(gas, work.right[i - 1], work.left[i], w[i]);
  const double p_w = wall_pressure(gas, work.right[n - 1], w[n]);
  flux[n] = wall_flux(p_w, w[n]);
  return p_w;
}

} // namespace

Workspace::Workspace(std::size_t n_cells)
    : mass(n_cells), momentum(n_cells), energy(n_cells), length(n_cells), cells(n_cells), left(n_cells), right(n_cells),
      flux_begin(n_cells + 1), flux_end(n_cells + 1)
{
}

void linear_node_velocities(double wall_velocity, std::span<double> node_velocity)
{
  const std::size_t last = node_velocity.size() - 1;
  for (std::size_t i = 0; i < last; ++i)
    node_velocity[i] = wall_velocity * (static_cast<double>(i) / static_cast<double>(last));
  node_velocity[last] = wall_velocity;
}

WallIntegrals advance(const State& state, std::span<const double> w_begin, std::span<const double> w_end, double dt,
                      const AleOptions& options, Workspace& workspace)
{
  const std::size_t n = state.n_cells();
  auto& f0 = workspace.flux_begin;
  auto& f1 = workspace.flux_end;

  // Stage 1: an Euler step with the velocities at the begin of the step.
  const double p_begin = face_fluxes(state, w_begin, options, workspace, f0);
  for (std::size_t i = 0; i < n; ++i) {
    workspace.mass[i] = state.mass[i] - dt * (f0[i + 1].mass - f0[i].mass);
    workspace.momentum[i] = state.momentum[i] - dt * (f0[i + 1].momentum - f0[i].momentum);
    workspace.energy[i] = state.energy[i] - dt * (f0[i + 1].energy - f0[i].energy);
    workspace.length[i] = state.length[i] + dt * (w_begin[i + 1] - w_begin[i]);
  }

  // Stage 2: the mean of both fluxes; a face takes from one cell what it gives to the other.
  const ConstState stage(workspace.mass, workspace.momentum, workspace.energy, workspace.length, state.node_x);
  const double p_end = face_fluxes(stage, w_end, options, workspace, f1);
  const double half = 0.5 * dt;
  for (std::size_t i = 0; i < n; ++i) {
    state.mass[i] -= half * ((f0[i + 1].mass + f1[i + 1].mass) - (f0[i].mass + f1[i].mass));
    state.momentum[i] -= half * ((f0[i + 1].momentum + f1[i + 1].momentum) - (f0[i].momentum + f1[i].momentum));
    state.energy[i] -= half * ((f0[i + 1].energy + f1[i + 1].energy) - (f0[i].energy + f1[i].energy));
    state.length[i] += half * ((w_begin[i + 1] + w_end[i + 1]) - (w_begin[i] + w_end[i]));
  }
  for (std::size_t i = 0; i <= n; ++i) state.node_x[i] += half * (w_begin[i] + w_end[i]);

  return {half * (p_begin + p_end), half * (p_begin * w_begin[n] + p_end * w_end[n]), half * (w_begin[n] + w_end[n])};
}

} // namespace mullion::euler_1d
