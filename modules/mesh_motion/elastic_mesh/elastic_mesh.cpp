// Mesh motion as if the mesh were an elastic body, stiff where its elements are small. What it does beyond its equation
// is interior_motion's.
#include "interior_motion/interior_motion.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::elastic_mesh {

class ElasticMesh final : public interior_motion::InteriorMotion {
public:
  struct Options : interior_motion::CommonOptions {
    double chi = 1.0;
    double poisson_ratio = 0.3;

    static constexpr auto table()
    {
      return std::tuple_cat(
          common_table(),
          std::tuple{parameter("chi", &Options::chi, "1",
                               "Young's modulus goes with the element's size to the power -chi", between(0.0, 2.0)),
                     parameter("poisson_ratio", &Options::poisson_ratio, "1", "nu: how much a squeezed mesh evades",
                               between(0.0, 0.45))});
    }
  };
  explicit ElasticMesh(const Options& options)
      : InteriorMotion(options), chi_(options.chi), poisson_ratio_(options.poisson_ratio)
  {
  }

private:
  [[nodiscard]] moving_mesh::MotionSolver solver(const moving_mesh::MovingMesh& mesh,
                                                 const std::vector<double>& measures,
                                                 const moving_mesh::IsGiven& is_given) const override
  {
    const auto stiffness = moving_mesh::inverse_measure_stiffness(measures, chi_);
    return moving_mesh::coupled_solver(moving_mesh::elasticity_matrix(mesh, stiffness, poisson_ratio_), is_given);
  }

  double chi_, poisson_ratio_;
};

} // namespace mullion::elastic_mesh

MULLION_PLUGIN(mullion::elastic_mesh::ElasticMesh, "mesh_motion", "elastic_mesh",
               "2D and 3D mesh that follows its wall as an elastic body");
