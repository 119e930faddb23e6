#include "added_mass_fluid.hpp"

#include <cmath>

namespace mullion::added_mass_fluid {
namespace {

constexpr Eigen::Index y = 1; ///< the component along n_f

void read_y(const ConstArray& vectors, std::vector<double>& to)
{
  to.resize(static_cast<std::size_t>(vectors.cols()));
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = vectors(y, static_cast<Eigen::Index>(i));
}

} // namespace

AddedMassFluid::AddedMassFluid(const Options& options)
    : options_(options), channel_{static_cast<std::size_t>(options.points), options.length, options.radius,
                                  options.density}
{
}

std::vector<FieldSpec> AddedMassFluid::fields()
{
  using enum Location;
  return {
      state("wall", "displacement", node, vector, "m", "eta^{n+1}, as received").overwritten(),
      state("wall", "displacement_before", node, vector, "m", "eta^n, at the begin of the step").overwritten(),
      state("wall", "step_size", pane, scalar, "s", "dt of the step; 0 before the first one").overwritten(),
      output("wall", "traction", element, vector, "Pa", "p n_f at the end of the step, n_f = (0, 1) out of the fluid"),
      output("wall", "work", pane, scalar, "J", "work of p on the wall in this step, for 1 m of depth"),
  };
}

std::vector<InputSpec> AddedMassFluid::inputs()
{
  return {receive("wall", "displacement", Location::node, vector, "m", "of the wall, at the end of the step")};
}

void AddedMassFluid::define(const TimeStep&)
{
  Coordinates points(2, options_.points);
  for (int i = 0; i < options_.points; ++i) points.col(i) << (i + 1) * channel_.dx(), channel_.radius;
  make_window("wall", {point_pane(points)});
  for (const auto& spec : fields()) field(spec.window, spec.name).now().setZero();
}

void AddedMassFluid::attach()
{
  matrix_ = added_mass_matrix(channel_);
  pressure_.resize(channel_.n_points);
  displacement_ = field("wall", "displacement");
  displacement_before_ = field("wall", "displacement_before");
  step_size_ = field("wall", "step_size");
  traction_ = field("wall", "traction");
  work_ = field("wall", "work");
  received_displacement_ = input("wall", "displacement");
}

void AddedMassFluid::step(const TimeStep& step)
{
  const double dt_before = step_size_.committed()(0, 0);
  MULLION_REQUIRE(dt_before == 0.0 || std::abs(step.dt - dt_before) <= 1e-9 * dt_before, Errc::config,
                  "a step of {} s follows one of {} s, but this fluid takes the wall's acceleration from steps of one "
                  "size; make [run] end_time a multiple of dt",
                  step.dt, dt_before);
  read_y(received_displacement_.newest(), next_);
  read_y(displacement_.committed(), now_);
  read_y(displacement_before_.committed(), before_);
  const WallMotion motion{next_, now_, before_};

  wall_pressure(channel_, matrix_, motion, step.dt, pressure_);

  displacement_.now() = received_displacement_.newest();
  displacement_before_.now() = displacement_.committed();
  step_size_.now()(0, 0) = step.dt;
  auto traction = traction_.now();
  for (int i = 0; i < options_.points; ++i) traction.col(i) << 0.0, pressure_[static_cast<std::size_t>(i)];
  work_.now()(0, 0) = wall_work(channel_, pressure_, motion);
}

} // namespace mullion::added_mass_fluid
