// The conventional serial staggered scheme (CSS): each solver once a step, one after the other.
//
//   order = structure_first  Algorithm 1 of Jaiman et al. 2011: the structure moves under the last known load, the
//                            fluid follows its motion
//   order = fluid_first      the fluid moves with the last known motion, the structure follows its load (Farhat)
//
// First order in time: the net lag between motion and load is 0.5 + alpha + beta steps (profile constant) or
// 1 + alpha + beta steps (profile linear), in either order.
#include <mullion/coupling/roles.hpp>

namespace mullion::css {

class Css final : public Driver {
public:
  struct Options : FsiOptions {
    double alpha = 0.0, beta = 0.0;
    std::string order = "structure_first";
    std::string load_time = "end";

    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{
              parameter("alpha", &Options::alpha, "1", "share of the old wall velocity in the one that the fluid gets",
                        between(0.0, 1.0))
                  .changeable(),
              parameter("beta", &Options::beta, "1", "share of the old traction in the load that the structure gets",
                        between(0.0, 1.0))
                  .changeable(),
              parameter("order", &Options::order, "", "who moves first", one_of("structure_first", "fluid_first"))},
          profile_option(), sampling_option(),
          std::tuple{parameter("load_time", &Options::load_time, "",
                               "the structure takes the load for the end of its step, or for its mean",
                               one_of("end", "mean"))},
          load_interpolation_option(), motion_option(), exchange_options());
    }
  };

  explicit Css(const Options& options) : options_(options), is_structure_first_(options.order == "structure_first")
  {
    MULLION_REQUIRE(
        is_structure_first_ || options.alpha == 0.0, Errc::config,
        "alpha = {} has no meaning with order = \"fluid_first\", where the fluid gets the old motion anyway; "
        "leave it out",
        options.alpha);
    if (options.load_time == "mean") options_.load_interpolation = "constant"; // a mean has no course within the step
  }

  void define(Wiring& wiring) override
  {
    const double alpha = options_.alpha, beta = options_.beta;
    names_ = wire_fsi(wiring, options_);
    wiring.state_like("load", names_.load);
    const double load_lag = options_.load_time == "end" ? options_.sampling_lag() : options_.sampling_lag() - 0.5;
    wiring.state_net_lag((options_.is_profile_linear() ? 1.0 : 0.5) + alpha + beta + load_lag);
    wiring.explain_divergence(added_mass_hint("css", "strong"));
  }

  void attach(Coupling& coupling) override
  {
    roles_ = FsiRoles(coupling, names_);
    load_ = coupling.state("load");
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    load_.now() = roles_.load_on_structure.now();
  }

  void step(const TimeStep& step) override
  {
    if (is_structure_first_) structure_first(step);
    else fluid_first(step);
  }

private:
  // Algorithm 1 (CSS), Jaiman et al. 2011
  void structure_first(const TimeStep& step)
  {
    const double alpha = options_.alpha, beta = options_.beta;
    const auto& v = roles_.structure_motion;
    const auto& p = roles_.load_on_structure;

    apply(load_.committed(), step);                                         // P_s^n stands for t^{n+1}: u_s, v_s at n+1
    roles_.move_fluid((1 - alpha) * v.now() + alpha * v.committed(), step); // v_f^{n+1}
    load_.now() = (1 - beta) * p.now() + beta * p.committed();              // P_s^{n+1}
  }

  void fluid_first(const TimeStep& step)
  {
    const double beta = options_.beta;
    const auto& p = roles_.load_on_structure;

    roles_.move_fluid(roles_.structure_motion.committed(), step); // v_s^n
    load_.now() = (1 - beta) * p.now() + beta * p.committed();
    apply(load_.now(), step);
  }

  template <class Values> void apply(const Values& load, const TimeStep& step) const
  {
    if (options_.load_time == "end") roles_.load_structure(load, step);
    else roles_.load_structure_mean(load, step);
  }

  Options options_;
  bool is_structure_first_;
  FsiNames names_;
  FsiRoles roles_;
  DriverField load_; ///< P_s, the load that the structure got or will get next
};

} // namespace mullion::css

MULLION_DRIVER(mullion::css::Css, "css", "conventional serial staggered scheme, alpha and beta (Algorithm 1)");
