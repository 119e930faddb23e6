// A structure at rest that waits in each step until the fluid is at work too: see meeting.hpp.
#include "../meeting.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class MeetingStructure final : public Module {
public:
  using Options = MeetingOptions;
  explicit MeetingStructure(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields() { return {state("wet", "velocity", Location::node, vector, "m/s", "none")}; }
  static std::vector<InputSpec> inputs()
  {
    return {receive("wet", "traction", Location::node, vector, "Pa", "traction of the fluid")};
  }

  void define(const TimeStep&) override
  {
    make_window("wet", {point_pane(Coordinates::Ones(1, 1))});
    field("wet", "velocity").now().setZero();
  }
  void attach() override {}
  void step(const TimeStep& step) override { meet(options_, "structure", "fluid", step); }

private:
  Options options_;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::MeetingStructure, "structure", "meeting_structure",
               "test structure that waits for the fluid");
