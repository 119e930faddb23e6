// The improved serial staggered scheme (ISS): fluid and structure leap over one another like a leap-frog, the fluid
// half a step behind (Lesoinne and Farhat 1998; Jaiman et al. 2011, section 4.3).
//
// Second order in time without iterating: the fluid's window is centred on the time of the velocity that moves it, the
// structure's step on the time of the traction that loads it. The exported pressure goes with the wall velocity of its
// own time, v^n + dt/2 a^n; with the window's velocity it would lose an order.
#include <mullion/coupling/half_step.hpp>
#include <mullion/coupling/roles.hpp>

namespace mullion::iss {

class Iss final : public Driver {
public:
  struct Options : FsiOptions {
    bool starts_early = false;
    bool w_end = true;

    Options() { load_interpolation = "constant"; }
    static constexpr auto table()
    {
      return std::tuple_cat(std::tuple{parameter("starts_early", &Options::starts_early, "", HalfStepClock::meaning),
                                       parameter("w_end", &Options::w_end, "",
                                                 "the exported pressure goes with the wall velocity at its own time")},
                            sampling_option(), exchange_options());
    }
  };
  explicit Iss(const Options& options) : options_(options) {}

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_, {.sends_evaluation_velocity = options_.w_end});
    clock_.define(wiring, options_.starts_early, {names_.fluid, names_.mesh_motion});
    wiring.state_net_lag(options_.sampling_lag());
    wiring.explain_divergence(added_mass_hint("iss", "strong"));
  }

  void attach(Coupling& coupling) override
  {
    roles_ = FsiRoles(coupling, names_);
    acceleration_ = coupling.field(names_.wet + ".acceleration");
    clock_.attach(coupling);
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    clock_.start(initial);
  }

  void step(const TimeStep& step) override
  {
    const auto& [v, a] = std::tie(roles_.structure_motion, acceleration_);
    const auto window = clock_.window(step); // around t^n

    if (options_.w_end) roles_.send_evaluation_velocity(v.committed() + 0.5 * step.dt * a.committed(), window);
    roles_.move_fluid(v.committed(), window);                         // v_s^n; P^{n+1/2}
    roles_.load_structure_mean(roles_.load_on_structure.now(), step); // n -> n+1
    clock_.end_step(step);
  }

private:
  Options options_;
  FsiNames names_;
  FsiRoles roles_;
  ModuleField acceleration_; ///< of the wet surface, in equilibrium with the load of its last step
  HalfStepClock clock_;
};

} // namespace mullion::iss

MULLION_DRIVER(mullion::iss::Iss, "iss", "improved serial staggered scheme: leap-frog, the fluid half a step behind");
