// A structure that wants its traction in psi: no connection may convert silently. Declarations only.
#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class WrongUnitStructure final : public Module {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };

  explicit WrongUnitStructure(const Options&) {}
  static std::vector<FieldSpec> fields()
  {
    return {state("wet", "velocity", Location::node, vector, "m/s", "velocity of the wet surface")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "psi", "traction of the fluid")};
  }
  void define(const TimeStep&) override {}
  void attach() override {}
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::WrongUnitStructure, "structure", "wrong_unit_structure", "test structure that wants psi");
