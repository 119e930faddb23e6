// The piston from bare kernels: gas and bar coupled by hand-written loops, one method a scheme. The reference that the
// framework's runs of the same cases must reproduce, to the bit where the scheme is the same.
#pragma once

#include "elastic_bar/initial_states.hpp"
#include "elastic_bar/newmark.hpp"
#include "euler_1d/ale_step.hpp"
#include "euler_1d/initial_states.hpp"
#include "euler_1d/wall.hpp"
#include "support/exact_piston.hpp"
#include "support/kernel_storage.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace mullion::testing {

enum class Profile { constant, linear }; // wall velocity within a step: v_end all along, or a ramp from v_begin
enum class Offset { none, half };        // where the gas starts: at t = 0 or at -dt/2

// Combined interface boundary conditions: the weight as it stands in either correction, so that a test can turn each
// sign round; the scheme has the same positive weight in both.
struct CibcWeights {
  double velocity = 0.0; // omega in rho_f dv/dt = -dp/dn + omega (P_t - P_s,t) [s/m]
  double traction = 0.0; // omega in P_s,t = P_t - (dp/dn + rho_f a_s) / omega [s/m]
};

// A piston that starts in its first closed mode, and one step of several schemes. Load step zero:
// p_ref = p_0.
class CoupledPiston {
public:
  static constexpr double amplitude = 1e-6; // [m]: relative nonlinearity 1e-6

  CoupledPiston(const Piston& piston, std::size_t n_cells, double dt, Offset offset = Offset::none)
      : piston_(piston), dt_(dt),
        omega_(closed_frequencies(piston, 1)[0]), bar_{.density = piston.solid_density(),
                                                       .youngs_modulus = piston.youngs_modulus(),
                                                       .length = piston.solid_length(),
                                                       .n_elements = static_cast<std::size_t>(
                                                           std::max(1.0, std::round(piston.solid_length() *
                                                                                    static_cast<double>(n_cells))))},
        gas_(n_cells), solid_(bar_), newmark_(bar_, dt)
  {
    euler_1d::set_acoustic_mode(gas_.state(), options_.gas, options_.reference,
                                {amplitude, omega_, piston.fluid_length}, offset == Offset::half ? -0.5 * dt : 0.0,
                                piston.fluid_length + amplitude);
    applied_ = wall(0.0);
    elastic_bar::set_mode(bar_, solid_.view(), amplitude, omega_, load(applied_));
    old_acceleration_ = a();
  }

  double u() const { return solid_.displacement[0]; }
  double v() const { return solid_.velocity[0]; }
  double a() const { return solid_.acceleration[0]; }
  double omega() const { return omega_; }
  double gas_end() const { return gas_.node_x.back(); }

  void css_structure_first(Profile profile) // Algorithm 1 with alpha = beta = 0, Jaiman et al. 2011
  {
    const double v_begin = v();
    newmark_.step(solid_.view(), load(applied_));
    move_gas(v_begin, v(), profile);
    applied_ = wall(v());
  }

  void css_fluid_first(Profile profile)
  {
    move_gas(gas_velocity_, v(), profile);
    gas_velocity_ = v();
    newmark_.step(solid_.view(), load(wall(v())));
  }

  void gss_trapezoidal() // velocity predicted with second order, load P^{n+1}, linear profile
  {
    const double predicted = v() + dt_ * (1.5 * a() - 0.5 * old_acceleration_);
    old_acceleration_ = a();
    move_gas(gas_velocity_, predicted, Profile::linear);
    gas_velocity_ = predicted;
    newmark_.step(solid_.view(), load(wall(predicted)));
  }

  void iss() // the gas lives half a step earlier
  {
    move_gas(v(), v(), Profile::constant);
    newmark_.step_mean(solid_.view(), load(wall(v() + 0.5 * dt_ * a())));
  }

  void explicit_lagfree() // central differences: the displacement is known before the load
  {
    const double u_begin = u();
    const double predicted = v() + dt_ * (1.5 * a() - 0.5 * old_acceleration_);
    old_acceleration_ = a();
    elastic_bar::central_difference_displacement(bar_, solid_.view(), dt_);
    const double mean_velocity = (u() - u_begin) / dt_;
    move_gas(mean_velocity, mean_velocity, Profile::constant);
    elastic_bar::central_difference_velocity(bar_, solid_.view(), dt_, load(wall(predicted)));
  }

  // Algorithm 3 of Jaiman et al. 2011, the consistent reading: the velocity's increment on v^n, the traction's with the
  // fluid's own new rate; linear profile.
  void cibc(CibcWeights omega)
  {
    start_cibc();
    const double v_begin = v();
    newmark_.step(solid_.view(), cibc_.applied);
    const double v_f = v_begin + velocity_increment(omega.velocity);
    move_gas(gas_velocity_, v_f, Profile::linear);
    gas_velocity_ = v_f;
    const Wall now = wall_values(v_f);
    const double rate = (now.traction - cibc_.now.traction) / dt_;
    end_cibc(now, now.traction + dt_ * (rate - residual(now) / omega.traction));
  }

  void cibc_printed(CibcWeights omega) // taken literally: on v^{n+1}, with the rate of the old loads; constant profile
  {
    start_cibc();
    newmark_.step(solid_.view(), cibc_.applied);
    const double v_f = v() + velocity_increment(omega.velocity);
    const double rate = (cibc_.applied - cibc_.applied_before) / dt_;
    move_gas(v_f, v_f, Profile::constant);
    const Wall now = wall_values(v_f);
    end_cibc(now, now.traction + dt_ * (rate - residual(now) / omega.traction));
  }

  void cibc_half_offset(CibcWeights omega) // ISS plus the traction's correction
  {
    move_gas(v(), v(), Profile::constant);
    const Wall now = wall_values(v() + 0.5 * dt_ * a());
    newmark_.step_mean(solid_.view(), now.traction - dt_ / omega.traction * residual(now));
  }

  void cibc_sub_iterated(CibcWeights omega, int n_sub_iterations) // the bar again, with the corrected traction
  {
    start_cibc();
    const GasColumn gas_begin = gas_;
    const BarMotion solid_begin = solid_;
    double traction = cibc_.applied;
    Wall now{};
    for (int k = 0; k <= n_sub_iterations; ++k) {
      gas_ = gas_begin;
      solid_ = solid_begin;
      newmark_.step(solid_.view(), traction);
      move_gas(gas_velocity_, v(), Profile::linear);
      now = wall_values(v());
      traction = now.traction - dt_ / omega.traction * residual(now);
    }
    gas_velocity_ = v();
    end_cibc(now, traction + (now.traction - cibc_.now.traction));
  }

  void strong() // fixed point on the velocity at the end of the step, linear profile
  {
    const GasColumn gas_begin = gas_;
    const BarMotion solid_begin = solid_;
    const double v_begin = v();
    double guess = v_begin + dt_ * a();
    for (int iteration = 0; iteration < 50; ++iteration) {
      gas_ = gas_begin;
      solid_ = solid_begin;
      move_gas(v_begin, guess, Profile::linear);
      newmark_.step(solid_.view(), load(wall(guess)));
      const double change = std::abs(v() - guess);
      guess = v();
      if (change <= 1e-11 * amplitude * omega_) // round-off of 1e5 Pa against p' of 0.1 Pa: 1e-12
        return;
    }
    FAIL("strong coupling did not converge in 50 iterations");
  }

private:
  struct Wall {
    double traction = 0.0; // P - p_ref [Pa]
    double gradient = 0.0; // dp/dn [Pa/m]
  };
  // What the collocated CIBC schemes remember: the wall at t^n and t^{n-1}, the loads applied until then.
  struct CibcHistory {
    bool has_started = false;
    Wall now, before;
    double applied = 0.0, applied_before = 0.0; // P_s^n, P_s^{n-1}, minus p_ref
  };

  Wall wall_values(double w)
  {
    const auto wall = euler_1d::wall_state(gas_.state(), options_.gas, w);
    return {load(wall.pressure), wall.pressure_gradient};
  }
  void start_cibc() // all rates zero
  {
    if (cibc_.has_started) return;
    const Wall now = wall_values(0.0);
    cibc_ = {true, now, now, now.traction, now.traction};
  }
  void end_cibc(const Wall& now, double applied)
  {
    cibc_.before = std::exchange(cibc_.now, now);
    cibc_.applied_before = std::exchange(cibc_.applied, applied);
  }
  double velocity_increment(double omega) const
  {
    const double fluid_rate = (cibc_.now.traction - cibc_.before.traction) / dt_;
    const double applied_rate = (cibc_.applied - cibc_.applied_before) / dt_;
    return dt_ / piston_.rho0 * (-cibc_.now.gradient + omega * (fluid_rate - applied_rate));
  }
  double residual(const Wall& wall) const { return wall.gradient + piston_.rho0 * a(); } // r [Pa/m]

  double wall(double w) { return euler_1d::wall_state(gas_.state(), options_.gas, w).pressure; }
  // F = A (P_s - p_ref), A = 1 m^2
  double load(double pressure) const { return pressure - piston_.p0; }
  void move_gas(double v_begin, double v_end, Profile profile)
  {
    gas_.advance(profile == Profile::constant ? v_end : v_begin, v_end, dt_, options_);
  }

  Piston piston_;
  double dt_;
  double omega_;
  elastic_bar::Bar bar_;
  euler_1d::AleOptions options_;
  GasColumn gas_;
  BarMotion solid_;
  elastic_bar::Newmark newmark_;
  double applied_ = 0.0;          // P_s^n
  double gas_velocity_ = 0.0;     // v_f^n
  double old_acceleration_ = 0.0; // a^{n-1}
  CibcHistory cibc_;
};

} // namespace mullion::testing
