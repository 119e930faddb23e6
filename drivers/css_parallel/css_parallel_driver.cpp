// The conventional parallel staggered scheme: both solvers start from the data of t^n and run at the same time, each
// in a process of its own if the case says so.
//
// First order in time; the net lag is 1.5 steps (profile constant) or 2 steps (profile linear).
#include <mullion/coupling/roles.hpp>

namespace mullion::css_parallel {

class CssParallel final : public Driver {
public:
  struct Options : FsiOptions {
    static constexpr auto table()
    {
      return std::tuple_cat(profile_option(), sampling_option(), load_interpolation_option(), exchange_options());
    }
  };
  explicit CssParallel(const Options& options) : options_(options) {}

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_);
    wiring.state_net_lag((options_.is_profile_linear() ? 2.0 : 1.5) + options_.sampling_lag());
    wiring.explain_divergence(added_mass_hint("css_parallel", "strong"));
  }

  void attach(Coupling& coupling) override { roles_ = FsiRoles(coupling, names_); }

  void start(const TimeStep& initial) override { roles_.start(initial); }

  void step(const TimeStep& step) override
  {
    const auto& [v, p] = std::tie(roles_.structure_motion, roles_.load_on_structure);

    roles_.send_motion(v.committed(), step); // v_s^n
    roles_.mesh_motion.step(step);
    roles_.structure_load.put(p.committed(), step.end); // P^n
    roles_.fluid.begin_step(step);
    roles_.structure.begin_step(step);
    roles_.fluid.await();
    roles_.structure.await();
    roles_.transfer_loads(step);
  }

private:
  Options options_;
  FsiNames names_;
  FsiRoles roles_;
};

} // namespace mullion::css_parallel

MULLION_DRIVER(mullion::css_parallel::CssParallel, "css_parallel",
               "conventional parallel staggered scheme: fluid and structure at the same time");
