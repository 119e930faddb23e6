// The driver of the coupled-step benchmark: structure, then fluid, each reading the other's field in place.
#include <mullion/coupling/driver.hpp>

namespace mullion::bench {

class EchoDriver final : public Driver {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit EchoDriver(const Options&) {}

  void define(Wiring& wiring) override
  {
    const auto& [wall, wet] = wiring.interfaces()[0];
    wiring.bind(wall + ".velocity", wet + ".velocity");
    wiring.bind(wet + ".traction", wall + ".traction");
    fluid_name_ = wiring.instance("fluid");
    structure_name_ = wiring.instance("structure");
  }
  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_);
    structure_ = coupling.module(structure_name_);
  }
  void start(const TimeStep&) override {}
  void step(const TimeStep& step) override
  {
    structure_.step(step);
    fluid_.step(step);
  }

private:
  std::string fluid_name_, structure_name_;
  ModuleProxy fluid_, structure_;
};

} // namespace mullion::bench

MULLION_DRIVER(mullion::bench::EchoDriver, "echo", "benchmark driver: both ways, in place");
