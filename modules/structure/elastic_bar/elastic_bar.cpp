#include "elastic_bar.hpp"

#include "initial_states.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace mullion::elastic_bar {

ElasticBar::ElasticBar(const Options& options) : options_(options)
{
  bar_ = {options.density,
          options.youngs_modulus,
          options.length,
          options.area,
          static_cast<std::size_t>(options.elements),
          options.far_end == "clamped" ? FarEnd::clamped : FarEnd::free};
  MULLION_REQUIRE(options.initial != "mode" || options.mode_angular_frequency > 0.0, Errc::config,
                  "initial = \"mode\" needs mode_angular_frequency, an eigenvalue of the coupled problem in rad/s");
}

std::vector<FieldSpec> ElasticBar::fields()
{
  using enum Location;
  return {
      state("body", "displacement", node, vector, "m", "u"),
      state("body", "velocity", node, vector, "m/s", "v"),
      state("body", "acceleration", node, vector, "m/s^2", "a, in equilibrium with the load of the last step"),
      output("body", "energy", pane, scalar, "J", "kinetic and elastic"),
      state("wet", "displacement", node, vector, "m", "u of the loaded end").overwritten(),
      state("wet", "velocity", node, vector, "m/s", "v of the loaded end").overwritten(),
      state("wet", "acceleration", node, vector, "m/s^2", "a of the loaded end").overwritten(),
      state("wet", "applied_load", pane, scalar, "N", "load on the loaded end, as the last step used it").overwritten(),
      output("wet", "work", pane, scalar, "J", "work of the load in this step"),
      output("wet", "impulse", pane, vector, "N s", "of the load in this step"),
  };
}

std::vector<InputSpec> ElasticBar::inputs()
{
  return {
      receive("wet", "traction", Location::node, vector, "Pa", "acts on the bar along +x, compression positive")
          .optional(),
      receive("wet", "load", Location::node, vector, "N", "instead of a traction").extensive().optional(),
  };
}

void ElasticBar::define(const TimeStep&)
{
  const int n = options_.elements;
  Coordinates nodes(1, n + 1);
  for (int i = 0; i <= n; ++i) nodes(0, i) = options_.origin + options_.length * i / n;
  make_window("body", {line_pane(nodes)});
  make_window("wet", {point_pane(nodes.leftCols(1))});
  look_up();
  if (options_.initial == "rest") set_rest(bar_, working_motion(), 0.0);
  else set_mode(bar_, working_motion(), options_.mode_amplitude, options_.mode_angular_frequency, 0.0);
  write_outputs(0.0, 0.0, 0.0);
}

void ElasticBar::attach() { look_up(); }

void ElasticBar::look_up()
{
  displacement_ = field("body", "displacement");
  velocity_ = field("body", "velocity");
  acceleration_ = field("body", "acceleration");
  energy_ = field("body", "energy");
  wet_displacement_ = field("wet", "displacement");
  wet_velocity_ = field("wet", "velocity");
  wet_acceleration_ = field("wet", "acceleration");
  applied_load_ = field("wet", "applied_load");
  work_ = field("wet", "work");
  impulse_ = field("wet", "impulse");
  traction_ = input("wet", "traction");
  load_ = input("wet", "load");
}

void ElasticBar::start(const TimeStep& initial)
{
  // The first acceleration is in equilibrium with the first load, which only the driver knows.
  const double load = load_at(initial.end);
  equilibrium_acceleration(bar_, flat(displacement_.now()), load, flat(acceleration_.now()));
  write_outputs(load, 0.0, 0.0);
}

void ElasticBar::step(const TimeStep& step)
{
  const auto motion = working_motion();
  const int n = options_.substeps;
  const double dt = step.dt / n;
  const bool is_implicit = options_.integrator == "newmark";
  MULLION_REQUIRE(is_implicit || dt <= max_dt(), Errc::numeric,
                  "a structural step of {} s is beyond the stability limit {} s of central_difference; use more "
                  "substeps, fewer elements or integrator = \"newmark\"",
                  dt, max_dt());
  if (is_implicit && (!newmark_ || newmark_->dt() != dt)) newmark_.emplace(bar_, dt);

  double work = 0.0, impulse = 0.0, load_before = applied_load_.committed()(0, 0), load = load_before;
  for (int m = 1; m <= n; ++m) {
    load = load_at(m == n ? step.end : step.begin + m * dt);
    const double u_before = motion.displacement[0];
    double mean_load = load;
    if (is_mean_load()) {
      if (is_implicit) newmark_->step_mean(motion, load);
      else central_difference_step_mean(bar_, motion, dt, load);
    } else {
      if (is_implicit) newmark_->step(motion, load);
      else central_difference_step(bar_, motion, dt, load);
      mean_load = 0.5 * (load_before + load);
    }
    work += interface_work(mean_load, u_before, motion.displacement[0]);
    impulse += mean_load * dt;
    load_before = load;
  }
  write_outputs(load, work, impulse);
}

double ElasticBar::max_dt()
{
  if (options_.integrator == "newmark") return std::numeric_limits<double>::max();
  return bar_.element_length() / std::sqrt(bar_.youngs_modulus / bar_.density); // c_s dt / dx <= 1
}

double ElasticBar::vacuum_frequency(double step)
{
  // Lumped linear elements: omega = (2 c_s / dx) sin(k dx / 2) with k L_s = pi / 2 (one end held) or pi (both free).
  const double dx = bar_.element_length(), dt = step / options_.substeps;
  const double k = std::numbers::pi / bar_.length * (bar_.far_end == FarEnd::clamped ? 0.5 : 1.0);
  const double omega = 2.0 * std::sqrt(bar_.youngs_modulus / bar_.density) / dx * std::sin(0.5 * k * dx);
  const double half = 0.5 * omega * dt; // what the integrator makes of it
  return (options_.integrator == "newmark" ? std::atan(half) : std::asin(std::min(1.0, half))) /
         (std::numbers::pi * dt);
}

Motion ElasticBar::working_motion() const
{
  return {flat(displacement_.now()), flat(velocity_.now()), flat(acceleration_.now())};
}

double ElasticBar::load_at(double t)
{
  MULLION_REQUIRE(traction_.is_connected() != load_.is_connected(), Errc::config,
                  "it receives a traction or a load, one of them; the driver connects {}",
                  traction_.is_connected() ? "both" : "neither");
  if (load_.is_connected()) return load_.at(t)(0, 0);
  return bar_.area * traction_.at(t)(0, 0);
}

bool ElasticBar::is_mean_load() { return traction_.is_connected() ? traction_.is_mean() : load_.is_mean(); }

void ElasticBar::write_outputs(double load, double work, double impulse) const
{
  const auto motion = working_motion();
  energy_.now()(0, 0) = kinetic_energy(bar_, motion.velocity) + potential_energy(bar_, motion.displacement);
  wet_displacement_.now()(0, 0) = motion.displacement[0];
  wet_velocity_.now()(0, 0) = motion.velocity[0];
  wet_acceleration_.now()(0, 0) = motion.acceleration[0];
  applied_load_.now()(0, 0) = load;
  work_.now()(0, 0) = work;
  impulse_.now()(0, 0) = impulse;
}

} // namespace mullion::elastic_bar
