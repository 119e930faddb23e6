// The smallest coupling: fluid and structure on matching nodes read each other's field in place, one after the other.
// No stored field, no transfer, no mesh motion: what remains is the cost and the correctness of the framework.
#include <mullion/coupling/driver.hpp>

namespace mullion::test {

class Exchange final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit Exchange(const Options&) {}

  void define(Wiring& wiring) override
  {
    fluid_name_ = wiring.instance("fluid");
    structure_name_ = wiring.instance("structure");
    const auto& [wall, wet] = wiring.interfaces()[0];
    wiring.bind(wall + ".velocity", wet + ".velocity");
    wiring.bind(wet + ".traction", wall + ".traction");
  }

  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_);
    structure_ = coupling.module(structure_name_);
  }

  void start(const TimeStep& initial) override
  {
    structure_.start(initial);
    fluid_.start(initial);
  }

  void step(const TimeStep& step) override
  {
    structure_.step(step); // with the fluid's traction of the last step
    fluid_.step(step);     // with the structure's velocity of this step
  }

private:
  std::string fluid_name_, structure_name_;
  ModuleProxy fluid_, structure_;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::Exchange, "exchange", "test driver: structure, then fluid, in place");
