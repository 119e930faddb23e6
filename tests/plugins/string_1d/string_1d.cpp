#include "string_1d.hpp"

#include <cmath>

namespace mullion::string_1d {
namespace {

constexpr Eigen::Index y = 1; ///< the component along which the string moves

void read_y(const ConstArray& vectors, std::vector<double>& to)
{
  to.resize(static_cast<std::size_t>(vectors.cols()));
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = vectors(y, static_cast<Eigen::Index>(i));
}

void write_y(const std::vector<double>& from, Array vectors)
{
  for (std::size_t i = 0; i < from.size(); ++i) vectors.col(static_cast<Eigen::Index>(i)) << 0.0, from[i];
}

} // namespace

String1d::String1d(const Options& options)
    : options_(options), string_{static_cast<std::size_t>(options.points),
                                 options.length,
                                 options.thickness,
                                 options.density,
                                 options.stiffness,
                                 options.tension}
{
}

std::vector<FieldSpec> String1d::fields()
{
  using enum Location;
  return {
      state("wet", "displacement", node, vector, "m", "eta^{n+1}").overwritten(),
      state("wet", "displacement_before", node, vector, "m", "eta^n, at the begin of the step").overwritten(),
      state("wet", "velocity", node, vector, "m/s", "(eta^{n+1} - eta^n) / dt").overwritten(),
      state("wet", "step_size", pane, scalar, "s", "dt of the step; 0 before the first one").overwritten(),
      output("wet", "work", pane, scalar, "J", "work of the traction in this step, without that of the pulse"),
      output("wet", "energy", pane, scalar, "J", "kinetic and elastic"),
      output("wet", "displacement_norm", pane, scalar, "m", "root of the sum of squares over the points"),
  };
}

std::vector<InputSpec> String1d::inputs()
{
  return {receive("wet", "traction", Location::node, vector, "Pa", "of the fluid, acts along +y out of the fluid")};
}

void String1d::define(const TimeStep&)
{
  Coordinates points(2, options_.points);
  for (int i = 0; i < options_.points; ++i) points.col(i) << (i + 1) * string_.dx(), options_.radius;
  make_window("wet", {point_pane(points)});
  for (const auto& spec : fields()) field(spec.window, spec.name).now().setZero();
}

void String1d::attach()
{
  for (auto* scratch : {&pressure_, &next_, &rate_}) scratch->resize(string_.n_points);
  displacement_ = field("wet", "displacement");
  displacement_before_ = field("wet", "displacement_before");
  velocity_ = field("wet", "velocity");
  step_size_ = field("wet", "step_size");
  work_ = field("wet", "work");
  energy_ = field("wet", "energy");
  norm_ = field("wet", "displacement_norm");
  traction_ = input("wet", "traction");
}

void String1d::step(const TimeStep& step)
{
  const double dt_before = step_size_.committed()(0, 0);
  MULLION_REQUIRE(dt_before == 0.0 || std::abs(step.dt - dt_before) <= 1e-9 * dt_before, Errc::config,
                  "a step of {} s follows one of {} s, but this string takes its inertia from steps of one size; make "
                  "[run] end_time a multiple of dt",
                  step.dt, dt_before);
  read_y(traction_.newest(), traction_y_);
  read_y(displacement_.committed(), now_);
  read_y(displacement_before_.committed(), before_);
  const Pulse pulse{options_.pulse_pressure, options_.pulse_end};
  for (std::size_t i = 0; i < string_.n_points; ++i)
    pressure_[i] = traction_y_[i] + pulse_pressure(pulse, static_cast<double>(i + 1) * string_.dx(), step.begin);

  implicit_euler(string_, pressure_, now_, before_, step.dt, next_);

  double squares = 0.0;
  for (std::size_t i = 0; i < string_.n_points; ++i) {
    rate_[i] = (next_[i] - now_[i]) / step.dt;
    squares += next_[i] * next_[i];
  }
  write_y(next_, displacement_.now());
  write_y(now_, displacement_before_.now());
  write_y(rate_, velocity_.now());
  step_size_.now()(0, 0) = step.dt;
  work_.now()(0, 0) = work(string_, traction_y_, next_, now_);
  energy_.now()(0, 0) = kinetic_energy(string_, rate_) + elastic_energy(string_, next_);
  norm_.now()(0, 0) = std::sqrt(squares);
}

} // namespace mullion::string_1d
