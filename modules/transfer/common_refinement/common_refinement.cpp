// Transfer by common refinement (Jiao & Heath 2004; Jaiman et al. 2011, Eq. (6)): the overlay of the two meshes has
// pieces that lie in one face of either side, on which products of shape functions are smooth and integrated exactly. A
// traction that the structure's space can hold arrives to round-off; force and, with adjoint motion, work are kept.
#include "surface_transfer/surface_transfer.hpp"

#include "surface/overlay_operators.hpp"
#include "surface/polyline_overlay.hpp"
#include "surface/surface_overlay.hpp"

#include <algorithm>
#include <numbers>

#include <mullion/sdk/plugin.hpp>

namespace mullion::common_refinement {

using surface_transfer::Pairing;

class CommonRefinement final : public surface_transfer::SurfaceTransfer {
public:
  struct Options : surface_transfer::CommonOptions {
    std::string metric = "source";
    std::string mass = "same";
    double feature_angle = 40.0;

    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{parameter("metric", &Options::metric, "",
                               "surface on which the integrals are taken: source keeps the force to round-off",
                               one_of("source", "target", "average")),
                     parameter("mass", &Options::mass, "",
                               "mass matrix that recovers traction: on the same metric (constants exact) or the "
                               "structure's native one",
                               one_of("same", "native")),
                     parameter("feature_angle", &Options::feature_angle, "deg",
                               "2D: a node that turns by more is a corner", between(0.0, 180.0))},
          common_table());
    }
  };
  explicit CommonRefinement(const Options& options) : SurfaceTransfer(options), options_(options) {}

private:
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure,
                             const surface_transfer::Wanted& wanted) const override
  {
    const auto metric = options_.metric == "source"   ? surface::Metric::source
                        : options_.metric == "target" ? surface::Metric::target
                                                      : surface::Metric::average;
    const auto mass = options_.mass == "same" ? surface::MassMetric::same : surface::MassMetric::native;
    surface::OverlayAssembly assembly(fluid, structure, wanted.location, metric, mass, wanted.fluid_mass,
                                      wanted.offsets);
    const auto take = [&](const surface::Subelement& piece) { assembly.add(piece); };
    Pairing pairing;
    pairing.keeps_force = metric == surface::Metric::source;
    if (fluid.dimension == 2) {
      surface::PolylineOverlayOptions overlay;
      overlay.feature_angle = options_.feature_angle * std::numbers::pi / 180.0;
      pairing.report = surface::overlay_polylines(fluid, structure, overlay, take);
    } else {
      surface::SurfaceOverlayOptions overlay;
      overlay.gap_tolerance =
          options_.gap_tolerance * std::max(surface::mean_face_size(fluid), surface::mean_face_size(structure));
      pairing.report = surface::overlay_surfaces(fluid, structure, overlay, take);
    }
    pairing.operators = assembly.finish(surface::FaceTree(structure, 0.0));
    return pairing;
  }

  Options options_;
};

} // namespace mullion::common_refinement

MULLION_PLUGIN(mullion::common_refinement::CommonRefinement, "transfer", "common_refinement",
               "loads integrated over the overlay of both meshes: conservative and second order");
