// A fluid with a parameter of every type, limit and obligation, for tests of the case reader. Declarations only.
#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class ManyParametersFluid final : public Module {
public:
  struct Options {
    double density = 0.0, courant = 0.5, offset = 0.25, reference_pressure = 0.0;
    int cells = 100;
    std::int64_t seed = 1;
    bool limited = true;
    std::string flux = "hllc", label = "none";
    static constexpr auto table()
    {
      return std::tuple{
          required_parameter("density", &Options::density, "kg/m^3", "mass per volume", above(0.0)),
          required_parameter("reference_pressure", &Options::reference_pressure, "Pa", "subtracted from the traction",
                             at_least(0.0)),
          parameter("courant", &Options::courant, "1", "Courant number", Range{0.0, 1.0, true, false, {}, 0}),
          parameter("offset", &Options::offset, "m", "any number"),
          parameter("cells", &Options::cells, "1", "number of cells", between(2, 1000)),
          parameter("seed", &Options::seed, "1", "any integer"),
          parameter("limited", &Options::limited, "", "limit the slopes"),
          parameter("flux", &Options::flux, "", "Riemann solver", one_of("hllc", "roe", "exact")),
          parameter("label", &Options::label, "", "any text")};
    }
  };

  explicit ManyParametersFluid(const Options&) {}
  static std::vector<FieldSpec> fields()
  {
    return {output("wall", "traction", Location::node, vector, "Pa", "traction on the structure")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wall", "velocity", Location::node, vector, "m/s", "velocity of the wall")};
  }
  void define(const TimeStep&) override {}
  void attach() override {}
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::ManyParametersFluid, "fluid", "many_parameters_fluid",
               "test fluid with a parameter of every type");
