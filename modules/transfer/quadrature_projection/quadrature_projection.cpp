// Transfer by quadrature projection (Cebral & Lohner 1997; Jaiman et al. 2011, Eq. (4)): Gauss points of the fluid's
// faces are projected on the structure, where their share goes to the shape functions. Keeps force and, with adjoint
// motion, work; a constant traction does not arrive exactly, because the structure's shape functions have kinks between
// points.
#include "surface_transfer/surface_transfer.hpp"

#include <cmath>

#include <mullion/sdk/plugin.hpp>

namespace mullion::quadrature_projection {

using surface_transfer::Pairing;

class QuadratureProjection final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    int points = 2;
    bool adaptive = false;
    double tolerance = 0.0;
    std::string mass = "same";

    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{parameter("points", &Options::points, "1", "Gauss points a direction on each fluid face",
                               between(1.0, 64.0)),
                     parameter("adaptive", &Options::adaptive, "",
                               "more points beside structure faces that would get none, and to meet the tolerance"),
                     parameter("tolerance", &Options::tolerance, "1",
                               "adaptive: change of the loads of a constant traction; 0: one point a structure face "
                               "will do",
                               at_least(0.0)),
                     parameter("mass", &Options::mass, "",
                               "mass matrix that recovers traction: from the same points or the structure's native one",
                               one_of("same", "native"))},
          common_table());
    }
  };
  explicit QuadratureProjection(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure) const override
  {
    Pairing pairing;
    const surface::FaceTree tree(structure, 0.0);
    const auto set =
        surface::quadrature_points(fluid, structure, tree, {options_.points, options_.adaptive, options_.tolerance});
    pairing.loads_of_nodes = surface::load_operator(fluid, structure, set.points, surface::Location::nodes);
    pairing.loads_of_faces = surface::load_operator(fluid, structure, set.points, surface::Location::faces);
    pairing.structure_mass =
        options_.mass == "same" ? surface::target_mass(structure, set.points) : surface::native_mass(structure);
    pairing.fluid_mass = surface::source_mass(fluid, set.points);
    pairing.motion = surface::node_projection(fluid, structure, tree);
    pairing.report = surface_transfer::report_of_points(fluid, structure, set);
    return pairing;
  }

  Options options_;
};

} // namespace mullion::quadrature_projection

MULLION_PLUGIN(mullion::quadrature_projection::QuadratureProjection, "transfer", "quadrature_projection",
               "loads by Gauss points of the fluid's faces, projected on the structure");
