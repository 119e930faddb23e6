#include "surface_transfer.hpp"

#include "surface/shape_functions.hpp"

#include <algorithm>
#include <utility>

namespace mullion::surface_transfer {

using surface::SurfaceMesh;

namespace {

/// Views of a window as the kernels take them.
surface::FieldView view(const ConstArray& values) { return {values}; }

} // namespace

surface::OverlayReport report_of_projection(const SurfaceMesh& fluid, const SurfaceMesh& structure,
                                            const surface::Operator& projection)
{
  surface::OverlayReport report;
  report.fit.resize(static_cast<std::size_t>(fluid.n_faces()));
  std::vector<double> gaps(static_cast<std::size_t>(fluid.n_nodes()), 0.0);
  std::vector<bool> is_reached(static_cast<std::size_t>(structure.n_nodes()), false);
  for (int row = 0; row < projection.outerSize(); ++row) {
    surface::Point place = surface::Point::Zero();
    for (surface::Operator::InnerIterator entry(projection, row); entry; ++entry) {
      if (entry.value() != 0.0) is_reached[static_cast<std::size_t>(entry.col())] = true;
      place += entry.value() * surface::node_position(structure, entry.col());
    }
    gaps[static_cast<std::size_t>(row)] = (place - surface::node_position(fluid, row)).norm();
  }
  for (std::int64_t f = 0; f < fluid.n_faces(); ++f) {
    auto& gap = report.fit[static_cast<std::size_t>(f)].gap;
    for (const auto node : fluid.face(f)) gap = std::max(gap, gaps[static_cast<std::size_t>(node)]);
    report.largest_gap = std::max(report.largest_gap, gap);
  }
  for (std::size_t node = 0; node < is_reached.size(); ++node)
    if (!is_reached[node]) report.unmatched_target_nodes.add(static_cast<std::int32_t>(node));
  return report;
}

PointReport::PointReport(const SurfaceMesh& fluid, const SurfaceMesh& structure)
    : fluid_(fluid), structure_(structure), is_reached_(static_cast<std::size_t>(structure.n_nodes()), false)
{
  report_.fit.resize(static_cast<std::size_t>(fluid.n_faces()));
}

void PointReport::add(std::int32_t fluid_face, std::span<const surface::IntegrationPoint> points)
{
  double& gap = report_.fit[static_cast<std::size_t>(fluid_face)].gap;
  for (const auto& point : points) {
    const auto here = surface::map_to_space(fluid_, point.source_face, point.source_xi);
    const auto there = surface::map_to_space(structure_, point.target_face, point.target_xi);
    gap = std::max(gap, (here - there).norm());
    for (const auto node : structure_.face(point.target_face)) is_reached_[static_cast<std::size_t>(node)] = true;
  }
  report_.largest_gap = std::max(report_.largest_gap, gap);
}

surface::OverlayReport PointReport::finish()
{
  for (std::size_t node = 0; node < is_reached_.size(); ++node)
    if (!is_reached_[node]) report_.unmatched_target_nodes.add(static_cast<std::int32_t>(node));
  return std::move(report_);
}

std::vector<FieldSpec> SurfaceTransfer::fields()
{
  using enum Location;
  const char* s = "structure_side";
  return {
      output(s, "traction", node, vector, "Pa", "acts on the structure"),
      output(s, "load", node, vector, "N", "acts on the structure's nodes; in 2D per metre of depth").extensive(),
      output(s, "force", pane, vector, "N", "sum of the loads"),
      output(s, "moment", pane, 3, "N m", "of the loads about the origin"),
      output(s, "fluid_force", pane, vector, "N", "integral of the fluid's traction over its own surface"),
      output(s, "fluid_moment", pane, 3, "N m", "the same of the moment"),
      output(s, "power", pane, scalar, "W",
             "of the loads on the structure's velocity; on its displacement, if that is "
             "what is received: the work"),
      output(s, "fluid_power", pane, scalar, "W", "of the fluid's traction on the motion that the fluid gets"),
      output(s, "area", pane, scalar, "m^2", "of the structure's surface; in 2D its length"),
      output(s, "fluid_area", pane, scalar, "m^2", "of the fluid's surface; in 2D its length"),
      output(s, "least_coverage", pane, scalar, "1", "of a fluid face by the structure, before any scaling"),
      output(s, "covered_fraction", pane, scalar, "1", "of the fluid's surface that has a counterpart"),
      output(s, "largest_gap", pane, scalar, "m", "between paired points"),
      output(s, "unmatched_nodes", pane, scalar, "1", "nodes of both sides without a counterpart"),
      output("fluid_side", "velocity", node, vector, "m/s", "of the wall; 0 if none is received"),
      output("fluid_side", "displacement", node, vector, "m", "of the wall; 0 if none is received"),
  };
}

std::vector<InputSpec> SurfaceTransfer::inputs()
{
  using enum Location;
  return {
      receive("fluid_side", "traction", element, vector, "Pa", "acts on the structure, one value a face").optional(),
      receive("fluid_side", "nodal_traction", node, vector, "Pa", "acts on the structure, linear between nodes")
          .optional(),
      receive("fluid_side", "load", node, vector, "N", "forces of the fluid's nodes").extensive().optional(),
      receive("structure_side", "velocity", node, vector, "m/s", "of the wet surface").optional(),
      receive("structure_side", "displacement", node, vector, "m", "of the wet surface").optional(),
  };
}

void SurfaceTransfer::define(const TimeStep&)
{
  const auto fluid = peer_pane("fluid", ""), structure = peer_pane("structure", "");
  make_window("fluid_side", {fluid});
  make_window("structure_side", {structure});
  for (const auto& spec : fields()) field(spec.window, spec.name).now().setZero();
}

void SurfaceTransfer::attach()
{
  fluid_mesh_ = mesh_of("fluid_side");
  structure_mesh_ = mesh_of("structure_side");
  MULLION_REQUIRE(fluid_mesh_.dimension == structure_mesh_.dimension, Errc::shape,
                  "the fluid's interface has {} coordinates a node, the structure's {}", fluid_mesh_.dimension,
                  structure_mesh_.dimension);
  fluid_measure_ = surface::total_measure(fluid_mesh_);
  structure_measure_ = surface::total_measure(structure_mesh_);

  const auto own = [&](const char* name) { return field("structure_side", name); };
  traction_ = own("traction"), load_ = own("load");
  force_ = own("force"), moment_ = own("moment");
  fluid_force_ = own("fluid_force"), fluid_moment_ = own("fluid_moment");
  power_ = own("power"), fluid_power_ = own("fluid_power");
  measure_ = own("area"), fluid_measure_field_ = own("fluid_area");
  coverage_ = own("least_coverage"), covered_fraction_ = own("covered_fraction");
  gap_ = own("largest_gap"), unmatched_ = own("unmatched_nodes");
  velocity_ = field("fluid_side", "velocity");
  displacement_ = field("fluid_side", "displacement");
  received_traction_ = input("fluid_side", "traction");
  received_nodal_traction_ = input("fluid_side", "nodal_traction");
  received_load_ = input("fluid_side", "load");
  received_velocity_ = input("structure_side", "velocity");
  received_displacement_ = input("structure_side", "displacement");

  const auto location = received_traction_.is_connected() ? surface::Location::faces : surface::Location::nodes;
  const bool needs_fluid_mass = options_.motion == "adjoint" || received_load_.is_connected();
  pairing_ = pair(fluid_mesh_, structure_mesh_,
                  {location, needs_fluid_mass ? surface::SourceMass::factorised : surface::SourceMass::left_out,
                   options_.offsets == "rigid_link" ? surface::Offsets::rigid_link : surface::Offsets::left_out});
  report_misfit();
  MULLION_REQUIRE(pairing_.operators.target_mass.is_solvable, Errc::numeric,
                  "the structure's mass matrix on the interface cannot be factorised; is its surface folded?");
  fluid_forces_ =
      location == surface::Location::faces ? surface::face_split(fluid_mesh_) : surface::native_mass(fluid_mesh_);
}

SurfaceMesh SurfaceTransfer::mesh_of(const std::string& window) const
{
  const auto mesh_pane = pane(window);
  for (const auto& block : mesh_pane.blocks)
    MULLION_REQUIRE(block.type != ElementType::point1, Errc::shape,
                    "it joins lines and surfaces; {} consists of points: use point_transfer", window);
  auto mesh = surface::mesh_of_blocks(mesh_pane.coordinates, mesh_pane.blocks);
  const auto complaint = surface::complaint_about(mesh);
  MULLION_REQUIRE(complaint.empty(), Errc::shape, "{}: {}", window, complaint);
  return mesh;
}

void SurfaceTransfer::report_misfit()
{
  surface::Tolerances tolerances;
  tolerances.gap_error = options_.gap_tolerance;
  tolerances.gap_warning = 0.25 * options_.gap_tolerance;
  auto verdict = surface::judge(fluid_mesh_, structure_mesh_, pairing_.report, tolerances);
  if (options_.on_misfit == "error" && !verdict.errors.empty()) {
    std::string text;
    for (const auto& error : verdict.errors) text += (text.empty() ? "" : "; ") + error;
    throw Error(Errc::shape, fmt::format("the two interfaces do not fit: {} (on_misfit = \"warn\" couples them all the "
                                         "same)",
                                         text));
  }
  verdict.warnings.insert(verdict.warnings.end(), verdict.errors.begin(), verdict.errors.end());
  for (const auto& warning : verdict.warnings) log().warning("{}", warning);
  std::vector<surface::FaceFit>().swap(pairing_.report.fit); // the places have been named
}

void SurfaceTransfer::report_defects(const surface::Balance& balance)
{
  if (has_reported_defects_) return;
  const auto& operators = pairing_.operators;
  // Of facial values the fluid's nodes feel an equal share, which is what only the projections hand on.
  const bool has_adjoint_motion = operators.is_projection || (options_.motion == "adjoint" &&
                                                              operators.source_location == surface::Location::nodes);
  const surface::Tolerances tolerances;
  const auto complaints = surface::complaints_about(
      balance, {.force = pairing_.keeps_force, .work = pairing_.keeps_force && has_adjoint_motion}, tolerances);
  if (complaints.empty()) return;
  has_reported_defects_ = true;
  const auto places = surface::places_of_lost_force(fluid_mesh_, operators.load, operators.source_location, tolerances);
  for (const auto& complaint : complaints)
    log().warning("{}{} (said once; history.csv has every step)", complaint,
                  places.empty() ? std::string() : "; the loads of " + places + " do not arrive whole");
}

// ---- loads -------------------------------------------------------------------------------------------------------

surface::FieldView SurfaceTransfer::fluid_traction() const
{
  return view((received_traction_.is_connected() ? received_traction_ : received_nodal_traction_).newest());
}

surface::Field SurfaceTransfer::loads_on_structure() const
{
  if (received_load_.is_connected())
    return surface::loads_from_loads(pairing_.operators, fluid_mesh_, view(received_load_.newest()));
  MULLION_REQUIRE(received_traction_.is_connected() || received_nodal_traction_.is_connected(), Errc::config,
                  "the driver connects neither traction nor nodal_traction nor load to fluid_side");
  return surface::loads_from_traction(pairing_.operators, fluid_traction());
}

surface::Field SurfaceTransfer::forces_on_fluid() const
{
  if (received_load_.is_connected()) return view(received_load_.newest());
  return surface::apply(fluid_forces_, fluid_traction());
}

surface::Resultant SurfaceTransfer::fluid_resultant() const
{
  if (received_load_.is_connected()) return surface::resultant_of_loads(fluid_mesh_, view(received_load_.newest()));
  return surface::resultant_of_traction(fluid_mesh_, fluid_traction(), pairing_.operators.source_location);
}

void SurfaceTransfer::loads(const TimeStep& step)
{
  const surface::Field loads = loads_on_structure();
  surface::Balance balance;
  load_.now() = loads;
  traction_.now() =
      surface::recover(pairing_.operators.target_mass, loads,
                       options_.recovery == "consistent" ? surface::Recovery::consistent : surface::Recovery::lumped);
  balance.target = surface::resultant_of_loads(structure_mesh_, loads);
  balance.source = fluid_resultant();
  const auto n = structure_mesh_.dimension;
  force_.now().col(0) = balance.target.force.head(n), fluid_force_.now().col(0) = balance.source.force.head(n);
  moment_.now().col(0) = balance.target.moment, fluid_moment_.now().col(0) = balance.source.moment;

  const auto& motion = received_velocity_.is_connected() ? received_velocity_ : received_displacement_;
  const bool is_first_exchange = step.index == 0; // loads go first there, no motion was sent yet
  if (motion.is_connected() && !is_first_exchange) {
    balance.target_work = surface::work_of(loads, view(motion.newest()));
    balance.source_work = surface::work_of(forces_on_fluid(), motion_of_fluid(motion.newest()));
    balance.work_scale = surface::work_scale_of(loads, view(motion.newest()));
  }
  power_.now()(0, 0) = balance.target_work, fluid_power_.now()(0, 0) = balance.source_work;
  report_defects(balance);

  measure_.now()(0, 0) = structure_measure_;
  fluid_measure_field_.now()(0, 0) = fluid_measure_;
  const auto& report = pairing_.report;
  coverage_.now()(0, 0) = report.min_coverage;
  covered_fraction_.now()(0, 0) = report.covered_fraction;
  gap_.now()(0, 0) = report.largest_gap;
  unmatched_.now()(0, 0) =
      static_cast<double>(report.unmatched_source_nodes.count + report.unmatched_target_nodes.count);
}

// ---- motion ------------------------------------------------------------------------------------------------------

surface::Field SurfaceTransfer::motion_of_fluid(const ConstArray& structure_motion) const
{
  return surface::motion_of_source(pairing_.operators, view(structure_motion),
                                   options_.motion == "adjoint" ? surface::Motion::adjoint
                                                                : surface::Motion::interpolate);
}

void SurfaceTransfer::motion(const TimeStep&)
{
  const auto carry = [&](const Input& received, const Field& result) {
    if (received.is_connected()) result.now() = motion_of_fluid(received.newest());
    else result.now().setZero();
  };
  carry(received_velocity_, velocity_);
  carry(received_displacement_, displacement_);
}

} // namespace mullion::surface_transfer
