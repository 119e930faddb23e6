#include "spring_mass.hpp"

namespace mullion::spring_mass {

std::vector<FieldSpec> SpringMass::fields()
{
  using enum Location;
  return {
      state("wet", "displacement", node, vector, "m", "u"),
      state("wet", "velocity", node, vector, "m/s", "v"),
      state("wet", "acceleration", node, vector, "m/s^2", "a, in balance with the load of the last step"),
      output("wet", "energy", pane, scalar, "J", "kinetic and elastic"),
  };
}

std::vector<InputSpec> SpringMass::inputs()
{
  return {receive("wet", "traction", Location::node, vector, "Pa", "acts on the mass along +x, compression positive")};
}

void SpringMass::define(const TimeStep&)
{
  make_window("wet", {point_pane(Coordinates::Constant(1, 1, options_.origin))});
  look_up();
  write({}); // at rest, the spring relaxed
}

void SpringMass::attach() { look_up(); }

void SpringMass::look_up()
{
  displacement_ = field("wet", "displacement");
  velocity_ = field("wet", "velocity");
  acceleration_ = field("wet", "acceleration");
  energy_ = field("wet", "energy");
  traction_ = input("wet", "traction");
}

void SpringMass::start(const TimeStep& initial)
{
  // The first acceleration is in balance with the first load, which only the driver knows.
  write({0.0, 0.0, balance(body_, 0.0, load_at(initial.end))});
}

void SpringMass::step(const TimeStep& step)
{
  // When a step begins, the working level of a state is a copy of the committed one.
  const Motion before{displacement_.now()(0, 0), velocity_.now()(0, 0), acceleration_.now()(0, 0)};
  write(newmark_step(body_, before, step.dt, load_at(step.end)));
}

double SpringMass::load_at(double t) { return options_.area * traction_.at(t)(0, 0); }

void SpringMass::write(const Motion& motion) const
{
  const auto& [u, v, a] = motion;
  displacement_.now()(0, 0) = u;
  velocity_.now()(0, 0) = v;
  acceleration_.now()(0, 0) = a;
  energy_.now()(0, 0) = 0.5 * body_.mass * v * v + 0.5 * body_.stiffness * u * u;
}

} // namespace mullion::spring_mass
