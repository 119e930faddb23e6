// What the surface transfers share: windows -> kernels -> windows. Two copies of the interface meshes, the operators
// between them, built once from the reference coordinates, and the actions that apply them. A plug-in adds a method:
// how the two meshes are paired.
//
// Windows: `fluid_side` and `structure_side`, the interface meshes of the two solvers.
#pragma once

#include "surface/balance.hpp"
#include "surface/mass_matrix.hpp"
#include "surface/operators.hpp"
#include "surface/transfer_operators.hpp"

#include <mullion/sdk/module.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace mullion::surface_transfer {

/// Options of every surface transfer. A plug-in's Options are these and those of its method.
struct CommonOptions {
  std::string recovery = "consistent";
  std::string motion = "interpolate";
  std::string offsets = "none";
  double gap_tolerance = 2.0;
  std::string on_misfit = "error";

  static constexpr auto common_table()
  {
    return std::tuple{
        parameter("recovery", &CommonOptions::recovery, "",
                  "nodal traction from loads: consistent (M t = R, best fit) or lumped (positive, smooths)",
                  one_of("consistent", "lumped")),
        parameter(
            "motion", &CommonOptions::motion, "",
            "fluid nodes get the structure's motion where they lie on it (interpolate), or the one that makes the "
            "work of both sides equal (adjoint)",
            one_of("interpolate", "adjoint")),
        parameter(
            "offsets", &CommonOptions::offsets, "",
            "what stands off from the structure: none (moved by what it is paired with) or rigid_link (turns with "
            "the structure, and moments arrive whole; small rotations)",
            one_of("none", "rigid_link")),
        parameter("gap_tolerance", &CommonOptions::gap_tolerance, "1",
                  "largest gap between the two surfaces, in mean face sizes; a quarter of it is a warning", above(0.0)),
        parameter("on_misfit", &CommonOptions::on_misfit, "",
                  "surfaces that lie too far apart or reach too far beyond one another: error or warn",
                  one_of("error", "warn"))};
  }
};

/// How two interface meshes are paired. The source of the kernels is the fluid's side.
struct Pairing {
  surface::TransferOperators operators;
  surface::OverlayReport report;
  bool keeps_force = true; ///< to round-off: the integrals are taken on the fluid's surface
};

/// What the pairing is for.
struct Wanted {
  surface::Location location;     ///< of the traction that the fluid exports
  surface::SourceMass fluid_mass; ///< is it needed?
  surface::Offsets offsets;
};

/// How well projected nodes meet the structure, as an overlay would report it.
/// @param projection  P (fluid nodes x structure nodes) [1]
[[nodiscard]] surface::OverlayReport report_of_projection(const surface::SurfaceMesh& fluid,
                                                          const surface::SurfaceMesh& structure,
                                                          const surface::Operator& projection);

/// The same of the points of a quadrature, as they come.
class PointReport {
public:
  PointReport(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure);

  void add(std::int32_t fluid_face, std::span<const surface::IntegrationPoint> points);
  [[nodiscard]] surface::OverlayReport finish();

private:
  const surface::SurfaceMesh& fluid_;
  const surface::SurfaceMesh& structure_;
  surface::OverlayReport report_;
  std::vector<bool> is_reached_; ///< the structure's nodes
};

class SurfaceTransfer : public Module {
public:
  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();
  static constexpr auto functions()
  {
    return std::tuple{
        action("loads", &SurfaceTransfer::loads, "structure_side", "traction or load, fluid to structure"),
        action("motion", &SurfaceTransfer::motion, "fluid_side", "velocity and displacement, structure to fluid")};
  }

  void define(const TimeStep& initial) override;
  void attach() override;
  void loads(const TimeStep& step);
  void motion(const TimeStep& step);

protected:
  explicit SurfaceTransfer(CommonOptions options) : options_(std::move(options)) {}

  /// Pair the two meshes. From reference coordinates alone, the same to the bit however often it is done.
  [[nodiscard]] virtual Pairing pair(const surface::SurfaceMesh& fluid, const surface::SurfaceMesh& structure,
                                     const Wanted& wanted) const = 0;

private:
  [[nodiscard]] surface::SurfaceMesh mesh_of(const std::string& window) const;
  void report_misfit();
  void report_defects(const surface::Balance& balance);
  [[nodiscard]] surface::FieldView fluid_traction() const;
  [[nodiscard]] surface::Field loads_on_structure() const;
  [[nodiscard]] surface::Field forces_on_fluid() const; ///< on its nodes [N]
  [[nodiscard]] surface::Resultant fluid_resultant() const;
  [[nodiscard]] surface::Field motion_of_fluid(const ConstArray& structure_motion) const;

  CommonOptions options_;
  surface::SurfaceMesh fluid_mesh_, structure_mesh_; ///< reference configuration; derived from the windows' panes
  Pairing pairing_;
  surface::Operator fluid_forces_; ///< the fluid's own nodal forces from its traction
  double fluid_measure_ = 0.0, structure_measure_ = 0.0;
  bool has_reported_defects_ = false; ///< of this instance; one that takes over may say it again
  Field traction_, load_, force_, moment_, fluid_force_, fluid_moment_;
  Field measure_, fluid_measure_field_, coverage_, covered_fraction_, gap_, unmatched_, power_, fluid_power_;
  Field velocity_, displacement_;
  Input received_traction_, received_nodal_traction_, received_load_, received_velocity_, received_displacement_;
};

} // namespace mullion::surface_transfer
