// Mesh motion by Laplace's equation with a stiffness that spares small elements. What it does beyond its equation is
// interior_motion's.
#include "interior_motion/interior_motion.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::laplacian {

class Laplacian final : public interior_motion::InteriorMotion {
public:
  struct Options : interior_motion::CommonOptions {
    std::string stiffness = "masud_hughes";

    static constexpr auto table()
    {
      return std::tuple_cat(
          common_table(),
          std::tuple{parameter("stiffness", &Options::stiffness, "",
                               "masud_hughes: 1 + tau_m, larger in small elements; uniform: 1 everywhere",
                               one_of("masud_hughes", "uniform"))});
    }
  };
  explicit Laplacian(const Options& options) : InteriorMotion(options), stiffness_(options.stiffness) {}

private:
  [[nodiscard]] moving_mesh::MotionSolver solver(const moving_mesh::MovingMesh& mesh,
                                                 const std::vector<double>& measures,
                                                 const moving_mesh::IsGiven& is_given) const override
  {
    const auto stiffness = stiffness_ == "uniform" ? std::vector<double>(measures.size(), 1.0)
                                                   : moving_mesh::masud_hughes_stiffness(measures);
    return moving_mesh::solver_by_component(moving_mesh::laplacian_matrix(mesh, stiffness), is_given);
  }

  std::string stiffness_;
};

} // namespace mullion::laplacian

MULLION_PLUGIN(mullion::laplacian::Laplacian, "mesh_motion", "laplacian",
               "2D and 3D mesh that follows its wall by Laplace's equation");
