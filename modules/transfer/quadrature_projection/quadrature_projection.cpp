// Transfer by quadrature projection (Cebral & Lohner 1997; Jaiman et al. 2011, Eq. (4)): Gauss points of the fluid's
// faces are projected on the structure, where their share goes to the shape functions. Keeps force and, with adjoint
// motion, work; a constant traction does not arrive exactly, because the structure's shape functions have kinks between
// points.
#include "surface_transfer/surface_transfer.hpp"

#include "surface/overlay_operators.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::quadrature_projection {

using surface_transfer::Pairing;

class QuadratureProjection final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    int points = 2;
    bool adaptive = false;
    double tolerance = 0.0;

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
                               at_least(0.0))},
          common_table());
    }
  };
  explicit QuadratureProjection(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure,
                             const surface_transfer::Wanted& wanted) const override
  {
    const surface::FaceTree tree(structure, 0.0);
    surface::OverlayAssembly assembly(fluid, structure, wanted.location, surface::Metric::source,
                                      surface::MassMetric::native, wanted.fluid_mass, wanted.offsets);
    surface_transfer::PointReport report(fluid, structure);
    surface::for_each_quadrature_face(fluid, structure, tree, {options_.points, options_.adaptive, options_.tolerance},
                                      [&](std::int32_t face, auto points) {
                                        assembly.add_points(face, points);
                                        report.add(face, points);
                                      });
    return {assembly.finish(tree), report.finish()};
  }

  Options options_;
};

} // namespace mullion::quadrature_projection

MULLION_PLUGIN(mullion::quadrature_projection::QuadratureProjection, "transfer", "quadrature_projection",
               "loads by Gauss points of the fluid's faces, projected on the structure");
