// Transfer between two interfaces that consist of the same points: the 1D piston, where the interface is one. Each
// point of one side belongs to the point of the other side that lies where it lies.
//
// Windows: `fluid_side` and `structure_side`, copies of the two interface meshes.
#pragma once

#include <mullion/sdk/module.hpp>

#include <vector>

namespace mullion::point_transfer {

class PointTransfer final : public Module {
public:
  struct Options {
    double gap_tolerance = 1e-9;
    static constexpr auto table()
    {
      return std::tuple{parameter("gap_tolerance", &Options::gap_tolerance, "m",
                                  "largest distance between two points that count as one", at_least(0.0))};
    }
  };
  explicit PointTransfer(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();
  static constexpr auto functions()
  {
    return std::tuple{
        action("loads", &PointTransfer::loads, "structure_side", "traction, fluid to structure"),
        action("motion", &PointTransfer::motion, "fluid_side", "velocity and displacement, structure to fluid")};
  }

  void define(const TimeStep& initial) override;
  void attach() override;
  void loads(const TimeStep& step);
  void motion(const TimeStep& step);

private:
  Options options_;
  std::vector<Index> structure_of_fluid_; ///< per fluid point; derived from the reference coordinates
  std::vector<Index> node_of_face_;       ///< per fluid point element
  Field traction_, velocity_, displacement_;
  Input received_traction_, received_velocity_, received_displacement_;
};

} // namespace mullion::point_transfer
