#include "euler_1d.hpp"

namespace mullion::euler_1d {

Euler1d::Euler1d(const Options& options) : options_(options)
{
  ale_.gas.gamma = options.gamma;
  ale_.limiter = options.limiter == "none" ? Limiter::none : Limiter::van_albada;
  ale_.left_end = options.left_end == "closed" ? LeftEnd::closed : LeftEnd::open;
  ale_.reference = {options.density, options.pressure};
  MULLION_REQUIRE(options.initial != "mode" || options.mode_angular_frequency > 0.0, Errc::config,
                  "initial = \"mode\" needs mode_angular_frequency, an eigenvalue of the coupled problem in rad/s");
}

std::vector<FieldSpec> Euler1d::fields()
{
  using enum Location;
  return {
      state("volume", "coordinates", node, vector, "m", "where the nodes are"),
      state("volume", "mass", element, scalar, "kg", "rho L of each cell, for 1 m^2"),
      state("volume", "momentum", element, scalar, "kg m/s", "rho u L of each cell, for 1 m^2"),
      state("volume", "energy", element, scalar, "J", "rho E L of each cell, for 1 m^2"),
      state("volume", "length", element, scalar, "m", "L of each cell, advanced with the same stages"),
      output("volume", "density", element, scalar, "kg/m^3", "cell mean"),
      output("volume", "velocity", element, vector, "m/s", "cell mean"),
      output("volume", "pressure", element, scalar, "Pa", "cell mean, absolute"),
      output("volume", "total_mass", pane, scalar, "kg", "of all cells"),
      output("volume", "total_energy", pane, scalar, "J", "of all cells"),
      output("wall", "traction", element, vector, "Pa", "(p - p_ref) n_f at the end of the step, n_f out of the fluid"),
      output("wall", "traction_mean", element, vector, "Pa",
             "the same, mean over the step as the scheme integrates it"),
      output("wall", "pressure_gradient", element, scalar, "Pa/m", "dp/dn_f at the end of the step"),
      output("wall", "sound_speed", element, scalar, "m/s", "at the end of the step"),
      output("wall", "wall_spacing", element, scalar, "m", "length dx_n of the cell at the wall"),
      output("wall", "work", pane, scalar, "J", "work of (p - p_ref) on the wall in this step"),
      output("wall", "impulse", pane, vector, "N s", "of (p - p_ref) n_f on the wall in this step"),
      fixed("wall", "volume_node", node, scalar, "1", "number of the node in volume").integer(),
  };
}

std::vector<InputSpec> Euler1d::inputs()
{
  return {
      receive("volume", "velocity", Location::node, vector, "m/s", "node velocity, at both ends of the step"),
      receive("wall", "evaluation_velocity", Location::node, vector, "m/s",
              "wall velocity that goes with the exported pressure; default: that of the step's end")
          .optional(),
  };
}

void Euler1d::define(const TimeStep& initial)
{
  const int n = options_.cells;
  Coordinates nodes(1, n + 1);
  for (int i = 0; i <= n; ++i) nodes(0, i) = options_.length * i / n;
  make_window("volume", {line_pane(nodes)});
  make_window("wall", {point_pane(nodes.rightCols(1))});
  look_up();
  field("wall", "volume_node").index_now()(0, 0) = n;

  if (options_.initial == "rest") {
    set_rest(working_state(), ale_.gas, ale_.reference, options_.length);
  } else {
    const AcousticMode mode{options_.mode_amplitude, options_.mode_angular_frequency, options_.length};
    set_acoustic_mode(working_state(), ale_.gas, ale_.reference, mode, initial.end, // -dt/2 where the clock is offset
                      options_.length + options_.mode_amplitude);
  }
  write_first_outputs(0.0);
}

void Euler1d::attach()
{
  look_up();
  const auto n = static_cast<std::size_t>(options_.cells);
  workspace_.emplace(n);
  w_begin_.resize(n + 1);
  w_end_.resize(n + 1);
}

void Euler1d::start(const TimeStep& initial)
{
  write_first_outputs(node_velocity_.at(initial.end)(0, coordinates_.values().cols() - 1)); // define did not know it
}

void Euler1d::write_first_outputs(double wall_velocity) const
{
  write_outputs(wall_velocity, wall_state(working_state(), ale_.gas, wall_velocity).pressure, 0.0, 0.0);
}

void Euler1d::look_up()
{
  coordinates_ = field("volume", "coordinates");
  mass_ = field("volume", "mass");
  momentum_ = field("volume", "momentum");
  energy_ = field("volume", "energy");
  length_ = field("volume", "length");
  density_ = field("volume", "density");
  velocity_ = field("volume", "velocity");
  pressure_ = field("volume", "pressure");
  total_mass_ = field("volume", "total_mass");
  total_energy_ = field("volume", "total_energy");
  traction_ = field("wall", "traction");
  traction_mean_ = field("wall", "traction_mean");
  pressure_gradient_ = field("wall", "pressure_gradient");
  sound_speed_ = field("wall", "sound_speed");
  wall_spacing_ = field("wall", "wall_spacing");
  work_ = field("wall", "work");
  impulse_ = field("wall", "impulse");
  node_velocity_ = input("volume", "velocity");
  evaluation_velocity_ = input("wall", "evaluation_velocity");
}

State Euler1d::working_state() const
{
  return {flat(mass_.now()), flat(momentum_.now()), flat(energy_.now()), flat(length_.now()), flat(coordinates_.now())};
}

void Euler1d::step(const TimeStep& step)
{
  const auto state = working_state();
  const int n = options_.substeps;
  const double dt = step.dt / n;
  const auto read = [&](int m, std::vector<double>& to) { // node velocity at the end of substep m
    const auto w = node_velocity_.at(m == n ? step.end : step.begin + m * dt);
    std::copy(w.data(), w.data() + w.size(), to.begin());
  };
  WallIntegrals wall;
  read(0, w_begin_);
  for (int m = 1; m <= n; ++m) {
    read(m, w_end_);
    wall += advance(state, w_begin_, w_end_, dt, ale_, *workspace_);
    std::swap(w_begin_, w_end_);
  }
  if (const auto bad = find_bad_cell(state, ale_.gas))
    throw Error(Errc::numeric,
                fmt::format("cell {} of {} (x = {} m) has the {} {}; a smaller step or coupling scheme "
                            "with less lag may help",
                            bad->cell, options_.cells, state.node_x[bad->cell], to_string(bad->fault), bad->value));
  const double end_velocity = w_begin_.back(); // after the swap: at the step's end
  const double wall_velocity = evaluation_velocity_.is_connected() ? evaluation_velocity_.newest()(0, 0) : end_velocity;
  write_outputs(wall_velocity, wall.impulse / step.dt, wall.work - options_.reference_pressure * wall.swept_volume,
                wall.impulse - options_.reference_pressure * step.dt);
}

void Euler1d::write_outputs(double wall_velocity, double mean_pressure, double work, double impulse) const
{
  const auto state = working_state();
  cell_fields(state, ale_.gas, flat(density_.now()), flat(velocity_.now()), flat(pressure_.now()));
  const auto sums = totals(state);
  total_mass_.now()(0, 0) = sums.mass;
  total_energy_.now()(0, 0) = sums.energy;
  const auto wall = wall_state(state, ale_.gas, wall_velocity);
  traction_.now()(0, 0) = wall.pressure - options_.reference_pressure; // n_f = +1
  traction_mean_.now()(0, 0) = mean_pressure - options_.reference_pressure;
  pressure_gradient_.now()(0, 0) = wall.pressure_gradient;
  sound_speed_.now()(0, 0) = wall.sound_speed;
  wall_spacing_.now()(0, 0) = wall.spacing;
  work_.now()(0, 0) = work;
  impulse_.now()(0, 0) = impulse;
}

} // namespace mullion::euler_1d
