// A fluid at rest that waits in each step until the structure is at work too: see meeting.hpp.
#include "../meeting.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class MeetingFluid final : public Module {
public:
  using Options = MeetingOptions;
  explicit MeetingFluid(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields()
  {
    return {output("wall", "traction", Location::element, vector, "Pa", "none"),
            fixed("wall", "volume_node", Location::node, scalar, "1", "number of the node in volume").integer(),
            state("volume", "coordinates", Location::node, vector, "m", "where the nodes are")};
  }
  static std::vector<InputSpec> inputs()
  {
    return {receive("volume", "velocity", Location::node, vector, "m/s", "node velocity")};
  }

  void define(const TimeStep&) override
  {
    Coordinates nodes(1, 2);
    nodes << 0.0, 1.0;
    make_window("volume", {line_pane(nodes)});
    make_window("wall", {point_pane(nodes.rightCols(1))});
    field("wall", "volume_node").index_now()(0, 0) = 1;
    field("wall", "traction").now().setZero();
  }
  void attach() override { traction_ = field("wall", "traction"); }
  void step(const TimeStep& step) override
  {
    meet(options_, "fluid", "structure", step);
    traction_.now().setZero();
  }

private:
  Options options_;
  Field traction_;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::MeetingFluid, "fluid", "meeting_fluid", "test fluid that waits for the structure");
