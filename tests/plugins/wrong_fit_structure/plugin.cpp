// A structure whose fields fit to nothing: elements instead of nodes, an amount instead of a density, two
// components. Declarations only.
#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class WrongFitStructure final : public Module {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };

  explicit WrongFitStructure(const Options&) {}
  static std::vector<FieldSpec> fields()
  {
    return {state("wet", "velocity", Location::element, vector, "m/s", "velocity of the elements").extensive(),
            state("wet", "pair", Location::node, 2, "m/s", "two components"),
            fixed("wet", "numbers", Location::node, vector, "m/s", "integers").integer()};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "Pa", "traction of the fluid").extensive(),
            receive("wet", "triple", Location::node, 3, "m/s", "three components").optional()};
  }
  void define(const TimeStep&) override {}
  void attach() override {}
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::WrongFitStructure, "structure", "wrong_fit_structure",
               "test structure whose fields fit to nothing");
