// The structure of the coupled-step benchmark.
#include "echo.hpp"

namespace mullion::bench {

class EchoStructure final : public Echo {
public:
  explicit EchoStructure(const Options& options) : Echo(options, "wet", "velocity", "traction") {}
  static std::vector<FieldSpec> fields()
  {
    return {output("wet", "velocity", Location::node, vector, "m/s", "0.5 traction + 1")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "Pa", "on the structure")};
  }
};

} // namespace mullion::bench

MULLION_PLUGIN(mullion::bench::EchoStructure, "structure", "echo_structure", "benchmark structure");
