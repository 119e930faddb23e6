// Coupling with an explicit structure without any lag: central differences give the displacement at t^{n+1} before the
// load at t^{n+1} is known, so the fluid can follow the true motion, and the structure's second half the true load.
//
//     u^{n+1} = u^n + dt v^n + dt^2/2 a^n;  v_f = (u^{n+1} - u^n) / dt, all along the step
//     P^{n+1}, with the wall velocity v^n + dt (3/2 a^n - 1/2 a^{n-1}) of its own time
//     a^{n+1} = M^-1 (P^{n+1} - K u^{n+1}),  v^{n+1} = v^n + dt/2 (a^n + a^{n+1})      by the structure's step
//
// Second order in time, no iteration, the fluid's mesh follows the structure to round-off. Only for structures whose
// displacement at the end of a step does not depend on the load of that step; checked in every step.
#include <mullion/coupling/predictor.hpp>
#include <mullion/coupling/roles.hpp>

#include <algorithm>

namespace mullion::explicit_lagfree {

class ExplicitLagfree final : public Driver {
public:
  struct Options : FsiOptions {
    static constexpr auto table() { return exchange_options(); }
  };
  explicit ExplicitLagfree(const Options& options) : options_(options) {}

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_, {.sends_evaluation_velocity = true});
    wiring.history(names_.wet, 2); // a^{n-1}
    wiring.state_numbers("previous_dt", 1);
    wiring.state_net_lag(0.0);
    wiring.explain_divergence(added_mass_hint("explicit_lagfree", "strong"));
  }

  void attach(Coupling& coupling) override
  {
    roles_ = FsiRoles(coupling, names_);
    displacement_ = coupling.field(names_.wet + ".displacement");
    acceleration_ = coupling.field(names_.wet + ".acceleration");
    previous_dt_ = coupling.state("previous_dt");
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    previous_dt_.now()(0, 0) = initial.dt;
  }

  void step(const TimeStep& step) override
  {
    const auto u = displacement_.committed(), v = roles_.structure_motion.committed(), a = acceleration_.committed();
    const double dt = step.dt, ratio = dt / previous_dt_.committed()(0, 0);

    const Eigen::MatrixXd u_end = u + dt * v + 0.5 * dt * dt * a;
    roles_.send_evaluation_velocity(predicted_velocity(v, a, acceleration_.committed(2), dt, ratio), step);
    roles_.move_fluid((u_end - u) / dt, step);
    roles_.load_structure(roles_.load_on_structure.now(), step); // P^{n+1}
    require_explicit(u_end, step);
    previous_dt_.now()(0, 0) = dt;
  }

private:
  /// The structure must have gone where the fluid already is.
  void require_explicit(const Eigen::MatrixXd& expected, const TimeStep& step) const
  {
    const auto found = displacement_.now();
    const double size = std::max({found.norm(), (found - displacement_.committed()).norm(), 1e-300});
    MULLION_REQUIRE((found - expected).norm() <= 1e-9 * size, Errc::config,
                    "explicit_lagfree needs a structure whose displacement at the end of a step does not depend on "
                    "that step's load; in step {} (t = {} s) '{}' moved by {:.6e} m where {:.6e} m was certain "
                    "beforehand. Use an explicit "
                    "integrator (central_difference) without substeps, or another scheme",
                    step.index, step.begin, names_.structure, (found - displacement_.committed()).norm(),
                    (expected - displacement_.committed()).norm());
  }

  Options options_;
  FsiNames names_;
  FsiRoles roles_;
  ModuleField displacement_, acceleration_; ///< of the wet surface
  DriverField previous_dt_;                 ///< dt_{n-1} [s]
};

} // namespace mullion::explicit_lagfree

MULLION_DRIVER(mullion::explicit_lagfree::ExplicitLagfree, "explicit_lagfree",
               "second order without iterating, for explicit structures");
