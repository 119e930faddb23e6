// The generalised serial staggered scheme (GSS): the fluid moves with a predicted velocity, the structure follows
// under the new traction or a mix of new and old. Algorithm 2 of Jaiman et al. 2011.
//
//   load = mean       P_s^{n+1} = (1 - beta) P^{n+1} + beta P^n      of fluid tractions
//   load = recursion  P_s^{n+1} = (1 - beta) P^{n+1} + beta P_s^n    as printed
//
// Second order in time with beta = 0 and profile = linear, the default; with beta = 1/2 the load is late by half a
// step (mean) or a whole one (recursion).
#include <mullion/coupling/predictor.hpp>
#include <mullion/coupling/roles.hpp>

namespace mullion::gss {

class Gss final : public Driver {
public:
  struct Options : FsiOptions {
    double a0 = 1.5, a1 = 0.5, beta = 0.0;
    std::string load = "mean";

    Options() { profile = "linear"; }
    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{
              parameter("a0", &Options::a0, "1", "predictor: factor of dt a^n; 1.5 for second order").changeable(),
              parameter("a1", &Options::a1, "1", "predictor: factor of -dt a^{n-1}; 0.5 for second order").changeable(),
              parameter("beta", &Options::beta, "1", "share of the old traction in the load that the structure gets",
                        between(0.0, 1.0))
                  .changeable(),
              parameter("load", &Options::load, "",
                        "the old traction: the fluid's of the last step (mean), or the last load (recursion)",
                        one_of("mean", "recursion"))},
          profile_option(), sampling_option(), load_interpolation_option(), exchange_options());
    }
  };

  explicit Gss(const Options& options) : options_(options)
  {
    MULLION_REQUIRE(options.load == "mean" || options.beta < 1.0, Errc::config,
                    "beta = 1 with load = \"recursion\" would keep the first load for ever; choose beta below 1");
  }

  void define(Wiring& wiring) override
  {
    const auto& [a0, a1, beta] = std::tie(options_.a0, options_.a1, options_.beta);
    names_ = wire_fsi(wiring, options_);
    wiring.history(names_.wet, 2); // a^{n-1}
    wiring.state_like("load", names_.load);
    wiring.state_numbers("previous_dt", 1);
    const double motion_lag = (options_.is_profile_linear() ? 0.0 : -0.5) + 1.0 - (a0 - a1);
    wiring.state_net_lag(motion_lag + options_.sampling_lag() + (options_.load == "mean" ? beta : beta / (1.0 - beta)));
    wiring.explain_divergence(added_mass_hint("gss", "strong"));
  }

  void attach(Coupling& coupling) override
  {
    roles_ = FsiRoles(coupling, names_);
    acceleration_ = coupling.field(names_.wet + ".acceleration");
    load_ = coupling.state("load");
    previous_dt_ = coupling.state("previous_dt");
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    load_.now() = roles_.load_on_structure.now();
    previous_dt_.now()(0, 0) = initial.dt; // a^{-1} = a^0: any ratio does
  }

  // Algorithm 2 (GSS), Jaiman et al. 2011
  void step(const TimeStep& step) override
  {
    const auto& [v, a, p] = std::tie(roles_.structure_motion, acceleration_, roles_.load_on_structure);
    const double beta = options_.beta, ratio = step.dt / previous_dt_.committed()(0, 0);

    roles_.move_fluid(
        predicted_velocity(v.committed(), a.committed(), a.committed(2), step.dt, ratio, options_.a0, options_.a1),
        step);
    const auto old = options_.load == "mean" ? p.committed() : load_.committed();
    load_.now() = (1 - beta) * p.now() + beta * old;
    roles_.load_structure(load_.now(), step);
    previous_dt_.now()(0, 0) = step.dt;
  }

private:
  Options options_;
  FsiNames names_;
  FsiRoles roles_;
  ModuleField acceleration_; ///< of the wet surface
  DriverField load_;         ///< P_s
  DriverField previous_dt_;  ///< dt_{n-1} [s]
};

} // namespace mullion::gss

MULLION_DRIVER(mullion::gss::Gss, "gss", "generalised serial staggered scheme: predicted motion (Algorithm 2)");
