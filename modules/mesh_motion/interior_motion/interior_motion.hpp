// What the mesh motions in two and three dimensions share: windows -> kernels -> windows. The wall's velocity goes in,
// an equation makes the velocity of all nodes of it, and the mesh that comes of it is looked at before the fluid moves
// there. A plug-in adds the equation.
//
// Windows: `volume`, the fluid's mesh; `wall`, the fluid's wall, where the velocity is received.
#pragma once

#include "moving_mesh/motion_equations.hpp"
#include "moving_mesh/quality.hpp"

#include <mullion/sdk/module.hpp>

#include <string>
#include <vector>

namespace mullion::interior_motion {

/// Options of every such mesh motion. A plug-in's Options are these and those of its equation.
struct CommonOptions {
  std::string slide, free;

  static constexpr auto common_table()
  {
    return std::tuple{
        parameter("slide", &CommonOptions::slide, "",
                  "flat sides along which nodes may move, with commas between: x_min, x_max, y_min, …; the "
                  "rest of the boundary stays where it is"),
        parameter("free", &CommonOptions::free, "",
                  "flat sides whose nodes go wherever the equation takes them, with commas between, as for slide: for "
                  "a wall whose end moves off the side")};
  }
};

class InteriorMotion : public Module {
public:
  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

protected:
  explicit InteriorMotion(CommonOptions options) : options_(std::move(options)) {}

  /// The equation, factored. From the reference mesh alone, the same to the bit however often it is done.
  [[nodiscard]] virtual moving_mesh::MotionSolver solver(const moving_mesh::MovingMesh& mesh,
                                                         const std::vector<double>& measures,
                                                         const moving_mesh::IsGiven& is_given) const = 0;

private:
  [[nodiscard]] std::vector<moving_mesh::Side> moving_sides() const;
  [[nodiscard]] Eigen::MatrixXd velocity_at(double t);
  void write_quality(const moving_mesh::Quality& quality) const;
  void warn_of(const moving_mesh::Quality& quality) const;
  void require_no_fold(const moving_mesh::Quality& quality, const Eigen::MatrixXd& moved, double t) const;

  CommonOptions options_;
  moving_mesh::MovingMesh mesh_; ///< reference configuration; derived from the window's pane, like all below
  std::vector<double> measures_;
  std::vector<Index> wall_nodes_;
  moving_mesh::MotionSolver solver_;
  Field velocity_, coordinates_, min_area_ratio_, min_shape_;
  Input wall_velocity_, fluid_coordinates_;
};

} // namespace mullion::interior_motion
