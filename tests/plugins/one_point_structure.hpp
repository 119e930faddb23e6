// The base of the structures that break the rule "state lives in windows": velocity = 0.5 traction + something that
// each of them keeps elsewhere. They run to the end, and nothing but --replay or --amnesia can tell.
#pragma once

#include <mullion/sdk/module.hpp>

#include <vector>

namespace mullion::test {

class OnePointStructure : public Module {
public:
  static std::vector<FieldSpec> fields()
  {
    return {state("wet", "velocity", Location::node, vector, "m/s", "velocity of the wet point").overwritten()};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "Pa", "traction of the fluid")};
  }

  void define(const TimeStep&) final
  {
    make_window("wet", {point_pane(Coordinates::Zero(3, 1))});
    field("wet", "velocity").now().setConstant(1e-3);
  }
  void attach() final
  {
    velocity_ = field("wet", "velocity");
    traction_ = input("wet", "traction");
  }
  void step(const TimeStep& step) final
  {
    const ConstArray traction = traction_.newest();
    velocity_.now() = 0.5 * traction;
    velocity_.now()(1, 0) += kept_elsewhere(step, traction(1, 0));
  }

protected:
  /// What does not come from a window, but should.
  virtual double kept_elsewhere(const TimeStep& step, double traction) = 0;

private:
  Field velocity_;
  Input traction_;
};

struct NoOptions {
  static constexpr auto table() { return std::tuple{}; }
};

} // namespace mullion::test
