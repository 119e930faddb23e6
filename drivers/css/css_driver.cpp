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
  struct Options {
    double alpha = 0.0, beta = 0.0;
    std::string order = "structure_first";
    std::string profile = "constant";

    static constexpr auto table()
    {
      return std::tuple{
          parameter("alpha", &Options::alpha, "1", "share of the old wall velocity in the one that the fluid gets",
                    between(0.0, 1.0)),
          parameter("beta", &Options::beta, "1", "share of the old traction in the load that the structure gets",
                    between(0.0, 1.0)),
          parameter("order", &Options::order, "", "who moves first", one_of("structure_first", "fluid_first")),
          parameter("profile", &Options::profile, "",
                    "wall velocity within a step: constant (the step's value) or linear (from the last step's value)",
                    one_of("constant", "linear"))};
    }
  };

  explicit Css(const Options& options) : options_(options), is_structure_first_(options.order == "structure_first")
  {
    MULLION_REQUIRE(
        is_structure_first_ || options.alpha == 0.0, Errc::config,
        "alpha = {} has no meaning with order = \"fluid_first\", where the fluid gets the old motion anyway; "
        "leave it out",
        options.alpha);
  }

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_.profile == "constant" ? TimePolicy::constant : TimePolicy::linear);
    wiring.state_like("load", names_.wet + ".traction");
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
    const auto& [alpha, beta, order, profile] = options_;
    const auto& v = roles_.motion_on_fluid;
    const auto& p = roles_.load_on_structure;

    roles_.structure_load.put(load_.committed(), step.end); // P_s^n stands for t^{n+1}
    roles_.structure.step(step);                            // u_s, v_s at n+1
    roles_.transfer_motion(step);
    roles_.wall_velocity.put((1 - alpha) * v.now() + alpha * v.committed(), step.end); // v_f^{n+1}
    roles_.mesh_motion.step(step);
    roles_.fluid.step(step);
    roles_.transfer_loads(step);
    load_.now() = (1 - beta) * p.now() + beta * p.committed(); // P_s^{n+1}
  }

  void fluid_first(const TimeStep& step)
  {
    const double beta = options_.beta;
    const auto& p = roles_.load_on_structure;

    roles_.transfer_motion(step); // v_s^n
    roles_.wall_velocity.put(roles_.motion_on_fluid.now(), step.end);
    roles_.mesh_motion.step(step);
    roles_.fluid.step(step);
    roles_.transfer_loads(step);
    load_.now() = (1 - beta) * p.now() + beta * p.committed();
    roles_.structure_load.put(load_.now(), step.end);
    roles_.structure.step(step);
  }

  Options options_;
  bool is_structure_first_;
  FsiNames names_;
  FsiRoles roles_;
  DriverField load_; ///< P_s, the load that the structure got or will get next
};

} // namespace mullion::css

MULLION_DRIVER(mullion::css::Css, "css", "conventional serial staggered scheme, alpha and beta (Algorithm 1)");
