// A driver that makes one mistake of choice when it declares its connections: each must be found by `mullion check`.
#include <mullion/coupling/driver.hpp>

namespace mullion::test {

class OddWiring final : public Driver {
public:
  struct Options {
    std::string mistake;
    static constexpr auto table()
    {
      return std::tuple{required_parameter("mistake", &Options::mistake, "", "what to do wrong")};
    }
  };
  explicit OddWiring(const Options& options) : mistake_(options.mistake)
  {
    MULLION_REQUIRE(mistake_ != "create", Errc::config, "these options contradict each other; choose others");
  }

  void define(Wiring& wiring) override
  {
    const auto& [wall, wet] = wiring.interfaces()[0];
    const auto is = [&](const char* mistake) { return mistake_ == mistake; };
    if (is("needs_transfer")) static_cast<void>(wiring.instance("transfer"));
    if (!is("unfed")) wiring.bind(wall + ".velocity", is("unknown_source") ? wet + ".velocty" : wet + ".velocity");
    if (is("quadratic_bound")) wiring.bind(wet + ".traction", wall + ".traction", TimePolicy::quadratic);
    else if (is("too_many_levels")) wiring.store(wet + ".traction", TimePolicy::constant, 8);
    else if (is("too_few_levels")) wiring.store(wet + ".traction", TimePolicy::quadratic, 1);
    else wiring.store(is("unknown_receiver") ? wet + ".tractoin" : wet + ".traction");
    if (is("twice")) wiring.bind(wet + ".traction", wall + ".traction");
    if (is("unknown_instance")) wiring.store("fluidd.wall.velocity");
    if (is("no_port")) wiring.store("wall velocity");
    if (is("states")) {
      wiring.state_like("increment", wall + ".pressure");
      wiring.state_numbers("factors", 0);
      wiring.state_numbers("factors", 1);
      wiring.state_levels(8);
    }
    if (is("histories")) {
      wiring.history("structure.wett", 2);
      wiring.history(wet, 8);
      wiring.history("structure", 1);
    }
    if (is("pair")) wiring.bind("structure.wet.triple", "structure.wet.pair");
    if (is("integers")) wiring.bind("structure.wet.triple", "structure.wet.numbers");
    if (is("constant_step")) wiring.require_constant_step();
  }
  void attach(Coupling&) override {}
  void start(const TimeStep&) override {}
  void step(const TimeStep&) override {}

private:
  std::string mistake_;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::OddWiring, "odd_wiring", "test driver that connects wrongly");
