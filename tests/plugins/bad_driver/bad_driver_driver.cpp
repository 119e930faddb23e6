// A driver that breaks the rule: the relaxation factor, which it lowers step by step, lies in a member instead of in
// driver/state.
#include <mullion/coupling/driver.hpp>

namespace mullion::test {

class BadDriver final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit BadDriver(const Options&) {}

  void define(Wiring& wiring) override
  {
    fluid_name_ = wiring.instance("fluid");
    structure_name_ = wiring.instance("structure");
    wall_ = wiring.interfaces()[0].fluid;
    wet_ = wiring.interfaces()[0].structure;
    wiring.bind(wall_ + ".velocity", wet_ + ".velocity");
    wiring.store(wet_ + ".traction");
  }

  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_);
    structure_ = coupling.module(structure_name_);
    traction_ = coupling.field(wall_ + ".traction");
    load_ = coupling.received(wet_ + ".traction");
  }

  void start(const TimeStep& initial) override
  {
    fluid_.start(initial);
    load_.put(traction_.now(), initial.end);
    structure_.start(initial);
  }

  void step(const TimeStep& step) override
  {
    relaxation_ *= 0.9;
    load_.put(relaxation_ * traction_.committed(), step.end);
    structure_.step(step);
    fluid_.step(step);
  }

private:
  std::string fluid_name_, structure_name_, wall_, wet_;
  ModuleProxy fluid_, structure_;
  ModuleField traction_;
  ReceivedField load_;
  double relaxation_ = 1.0;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::BadDriver, "bad_driver", "test driver with state in a member");
