#include "probe_structure.hpp"

#include "probe_module/probe_module.hpp"
#include "surface/balance.hpp"

namespace mullion::probe_structure {

using probe_module::compiled;

std::vector<FieldSpec> ProbeStructure::fields()
{
  using enum Location;
  const char* w = "wet";
  return {
      state(w, "displacement", node, vector, "m", "the function").overwritten(),
      state(w, "velocity", node, vector, "m/s", "velocity, or the function").overwritten(),
      output(w, "load_error_l2", pane, scalar, "1", "of the received traction, mean over the surface, relative"),
      output(w, "load_error_max", pane, scalar, "1", "of the received traction, over the nodes, relative"),
      output(w, "area", pane, scalar, "m^2", "of the surface; in 2D its length"),
      output(w, "force", pane, vector, "N", "sum of the received loads, or integral of the received traction"),
      output(w, "moment", pane, 3, "N m", "the same about the origin"),
      output(w, "power", pane, scalar, "W", "the same on the velocity"),
  };
}

std::vector<InputSpec> ProbeStructure::inputs()
{
  return {receive("wet", "traction", Location::node, vector, "Pa", "acts on the structure").optional(),
          receive("wet", "load", Location::node, vector, "N", "acts on the structure's nodes").extensive().optional()};
}

void ProbeStructure::define(const TimeStep& initial)
{
  make_window("wet", {probe_module::read_pane(options_.mesh, options_.group)});
  look_up();
  write(initial.end, false);
}

void ProbeStructure::attach() { look_up(); }

void ProbeStructure::look_up()
{
  const auto wet = pane("wet");
  surface_ = probe_module::sampled_pane(wet, options_.mesh, options_.reverse_normal);
  const auto dimension = wet.coordinates.rows();
  function_ = compiled("function", options_.function, "components", dimension);
  velocity_function_ =
      compiled("velocity", options_.velocity.empty() ? options_.function : options_.velocity, "components", dimension);
  expected_traction_ = compiled("expected_traction", options_.expected_traction, options_.along, dimension);
  displacement_ = field("wet", "displacement");
  velocity_ = field("wet", "velocity");
  load_error_l2_ = field("wet", "load_error_l2");
  load_error_max_ = field("wet", "load_error_max");
  area_ = field("wet", "area");
  force_ = field("wet", "force");
  moment_ = field("wet", "moment");
  power_ = field("wet", "power");
  traction_ = input("wet", "traction");
  load_ = input("wet", "load");
}

void ProbeStructure::write(double t, bool is_received) const
{
  const auto at_time = [t](const auto& f) {
    return [&f, t](const Eigen::VectorXd& x, const Eigen::VectorXd& n) { return (*f)(x, n, t); };
  };
  try {
    displacement_.now() = probes::on_nodes(surface_, at_time(function_));
    velocity_.now() = probes::on_nodes(surface_, at_time(velocity_function_));
    area_.now()(0, 0) = surface::total_measure(surface_.mesh);
    write_received(t, is_received);
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::numeric, error.what());
  }
}

void ProbeStructure::write_received(double t, bool is_received) const
{
  const probes::SurfaceFunction f = [&](const Eigen::VectorXd& x, const Eigen::VectorXd& n) {
    return (*expected_traction_)(x, n, t);
  };
  surface::Resultant sum;
  double power = 0.0;
  probes::NodalNorms error;
  if (is_received && load_.is_connected()) {
    sum = surface::resultant_of_loads(surface_.mesh, load_.newest());
    power = surface::work_of(load_.newest(), velocity_.now());
    error = probes::relative_error(surface_, probes::per_weight(surface_, load_.newest()),
                                   probes::per_weight(surface_, probes::loads_of(surface_, f)));
  } else if (is_received && traction_.is_connected()) {
    const auto at_nodes = surface::Location::nodes;
    sum = surface::resultant_of_traction(surface_.mesh, traction_.newest(), at_nodes);
    power = probes::power_of_traction(surface_, traction_.newest(), at_nodes, velocity_.now());
  }
  if (is_received && traction_.is_connected()) // where both come, the traction is what is compared
    error = probes::relative_error(surface_, traction_.newest(), probes::on_nodes(surface_, f));
  load_error_l2_.now()(0, 0) = error.l2;
  load_error_max_.now()(0, 0) = error.max;
  force_.now() = sum.force.head(surface_.mesh.dimension);
  moment_.now() = sum.moment;
  power_.now()(0, 0) = power;
}

} // namespace mullion::probe_structure
