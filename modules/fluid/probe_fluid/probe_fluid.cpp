#include "probe_fluid.hpp"

#include "probe_module/probe_module.hpp"
#include "surface/balance.hpp"

namespace mullion::probe_fluid {

using probe_module::compiled;

std::vector<FieldSpec> ProbeFluid::fields()
{
  using enum Location;
  const char* w = "wall";
  return {
      output(w, "traction", element, vector, "Pa", "the function at the face's centre; acts on the structure"),
      output(w, "nodal_traction", node, vector, "Pa", "the function at the node, with the mean normal"),
      output(w, "load", node, vector, "N", "integral of the function with the node's shape function").extensive(),
      output(w, "motion_error_l2", pane, scalar, "1", "of the received motion, mean over the surface, relative"),
      output(w, "motion_error_max", pane, scalar, "1", "of the received motion, over the nodes, relative"),
      output(w, "area", pane, scalar, "m^2", "of the surface; in 2D its length"),
      output(w, "force", pane, vector, "N", "of the field that on names"),
      output(w, "moment", pane, 3, "N m", "the same about the origin"),
      output(w, "power", pane, scalar, "W", "the same on the received velocity; on the displacement: the work"),
  };
}

std::vector<InputSpec> ProbeFluid::inputs()
{
  return {receive("wall", "velocity", Location::node, vector, "m/s", "of the wall").optional(),
          receive("wall", "displacement", Location::node, vector, "m", "of the wall").optional()};
}

void ProbeFluid::define(const TimeStep& initial)
{
  make_window("wall", {probe_module::read_pane(options_.mesh, options_.group)});
  look_up();
  write(initial.end, false);
}

void ProbeFluid::attach() { look_up(); }

void ProbeFluid::look_up()
{
  const auto wall = pane("wall");
  surface_ = probe_module::sampled_pane(wall, options_.mesh, options_.reverse_normal);
  function_ = compiled("function", options_.function, options_.along, wall.coordinates.rows());
  expected_motion_ = compiled("expected_motion", options_.expected_motion, "components", wall.coordinates.rows());
  traction_ = field("wall", "traction");
  nodal_traction_ = field("wall", "nodal_traction");
  load_ = field("wall", "load");
  motion_error_l2_ = field("wall", "motion_error_l2");
  motion_error_max_ = field("wall", "motion_error_max");
  area_ = field("wall", "area");
  force_ = field("wall", "force");
  moment_ = field("wall", "moment");
  power_ = field("wall", "power");
  velocity_ = input("wall", "velocity");
  displacement_ = input("wall", "displacement");
}

void ProbeFluid::write(double t, bool is_received) const
{
  const probes::SurfaceFunction f = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& n) {
    return (*function_)(x, n, t);
  };
  try {
    traction_.now() = probes::on_faces(surface_, f);
    nodal_traction_.now() = probes::on_nodes(surface_, f);
    load_.now() = probes::loads_of(surface_, f);
    area_.now()(0, 0) = surface::total_measure(surface_.mesh);
    write_resultant();
    write_motion(t, is_received);
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::numeric, error.what());
  }
}

void ProbeFluid::write_resultant() const
{
  surface::Resultant sum;
  if (options_.on == "load") sum = surface::resultant_of_loads(surface_.mesh, load_.now());
  else if (options_.on == "faces")
    sum = surface::resultant_of_traction(surface_.mesh, traction_.now(), surface::Location::faces);
  else sum = surface::resultant_of_traction(surface_.mesh, nodal_traction_.now(), surface::Location::nodes);
  force_.now() = sum.force.head(surface_.mesh.dimension);
  moment_.now() = sum.moment;
}

void ProbeFluid::write_motion(double t, bool is_received) const
{
  double power = 0.0;
  probes::NodalNorms error;
  const Input& motion = velocity_.is_connected() ? velocity_ : displacement_;
  if (is_received && motion.is_connected()) {
    const auto received = motion.newest();
    const auto expected = probes::on_nodes(
        surface_, [&](const Eigen::VectorXd& x, const Eigen::VectorXd& n) { return (*expected_motion_)(x, n, t); });
    error = probes::relative_error(surface_, received, expected);
    if (options_.on == "load") power = surface::work_of(load_.now(), received);
    else if (options_.on == "faces")
      power = probes::power_of_traction(surface_, traction_.now(), surface::Location::faces, received);
    else power = probes::power_of_traction(surface_, nodal_traction_.now(), surface::Location::nodes, received);
  }
  motion_error_l2_.now()(0, 0) = error.l2;
  motion_error_max_.now()(0, 0) = error.max;
  power_.now()(0, 0) = power;
}

} // namespace mullion::probe_fluid
