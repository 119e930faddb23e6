// CSS whose every module is stepped three times in each coupling step, twice with wrong input: if re-arming loses
// nothing and leaks nothing, the run has the bytes of plain CSS.
#include <mullion/coupling/roles.hpp>

namespace mullion::test {

class CssIterated final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit CssIterated(const Options&) {}

  void define(Wiring& wiring) override
  {
    FsiOptions options;
    options.profile = "linear";
    names_ = wire_fsi(wiring, options);
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
    constexpr double wrong[] = {1.5, 0.5, 1.0}; // the last one counts
    for (int k = 0; k < 3; ++k) {
      TimeStep iteration = step;
      iteration.iteration = k;
      roles_.structure_load.put(wrong[k] * load_.committed(), step.end);
      roles_.structure.step(iteration);
      roles_.send_motion(wrong[k] * roles_.structure_motion.now(), iteration);
      roles_.mesh_motion.step(iteration);
      roles_.fluid.step(iteration);
      roles_.transfer_loads(iteration);
    }
    load_.now() = roles_.load_on_structure.now();
  }

private:
  FsiNames names_;
  FsiRoles roles_;
  DriverField load_;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::CssIterated, "css_iterated", "test driver: CSS with every step done three times");
