// Transfer by common refinement (Jiao & Heath 2004; Jaiman et al. 2011, Eq. (6)): the overlay of the two meshes has
// pieces that lie in one face of either side, on which products of shape functions are smooth and integrated exactly. A
// traction that the structure's space can hold arrives to round-off; force and, with adjoint motion, work are kept.
#include "surface_transfer/surface_transfer.hpp"

#include "surface/polyline_overlay.hpp"
#include "surface/surface_overlay.hpp"

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
  [[nodiscard]] Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure) const override
  {
    using surface::Metric;
    Pairing pairing;
    std::vector<surface::Subelement> pieces;
    const auto keep = [&](const surface::Subelement& piece) { pieces.push_back(piece); };
    if (fluid.dimension == 2) {
      surface::PolylineOverlayOptions overlay;
      overlay.feature_angle = options_.feature_angle * std::numbers::pi / 180.0;
      pairing.report = surface::overlay_polylines(fluid, structure, overlay, keep);
    } else {
      pairing.report = surface::overlay_surfaces(fluid, structure, {}, keep);
    }
    const auto metric = options_.metric == "source"   ? Metric::source
                        : options_.metric == "target" ? Metric::target
                                                      : Metric::average;
    const auto set = surface::points_of_overlay(fluid, structure, pieces, metric);
    pairing.loads_of_nodes = surface::load_operator(fluid, structure, set.points, surface::Location::nodes);
    pairing.loads_of_faces = surface::load_operator(fluid, structure, set.points, surface::Location::faces);
    pairing.structure_mass =
        options_.mass == "same" ? surface::target_mass(structure, set.points) : surface::native_mass(structure);
    pairing.fluid_mass = surface::source_mass(fluid, set.points);
    pairing.motion = surface::node_projection(fluid, structure, surface::FaceTree(structure, 0.0));
    return pairing;
  }

  Options options_;
};

} // namespace mullion::common_refinement

MULLION_PLUGIN(mullion::common_refinement::CommonRefinement, "transfer", "common_refinement",
               "loads integrated over the overlay of both meshes: conservative and second order");
