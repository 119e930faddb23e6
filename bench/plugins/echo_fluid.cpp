// The fluid of the coupled-step benchmark.
#include "echo.hpp"

namespace mullion::bench {

class EchoFluid final : public Echo {
public:
  explicit EchoFluid(const Options& options) : Echo(options, "wall", "traction", "velocity") {}
  static std::vector<FieldSpec> fields()
  {
    return {output("wall", "traction", Location::node, vector, "Pa", "0.5 velocity + 1")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wall", "velocity", Location::node, vector, "m/s", "of the wall")};
  }
};

} // namespace mullion::bench

MULLION_PLUGIN(mullion::bench::EchoFluid, "fluid", "echo_fluid", "benchmark fluid");
