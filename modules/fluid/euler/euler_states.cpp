// What the case says of the gas: the states that its boundary conditions need, and the first state, from functions of
// place and time or from a file.
#include "euler.hpp"

#include "saved_state.hpp"

#include <cmath>

namespace mullion::euler {

std::vector<Condition<2>> Euler::conditions() const
{
  const double g = options_.gamma;
  const double c = sound_speed<2>(scheme_.gas, free_stream_);
  const double heat = 1.0 + 0.5 * (g - 1.0) * square_of_velocity<2>(free_stream_) / (c * c); // T_0 / T
  Condition<2> condition;
  condition.state = free_stream_;
  condition.total_pressure =
      options_.total_pressure > 0.0 ? options_.total_pressure : options_.pressure * std::pow(heat, g / (g - 1.0));
  condition.total_sound_speed = options_.total_temperature > 0.0
                                    ? std::sqrt(g * options_.gas_constant * options_.total_temperature)
                                    : c * std::sqrt(heat);
  condition.pressure = options_.outflow_pressure > 0.0 ? options_.outflow_pressure : options_.pressure;
  std::vector<Condition<2>> conditions;
  for (const auto kind : patches_.kinds) {
    conditions.push_back(condition);
    conditions.back().kind = kind;
    if (kind != Kind::prescribed) continue;
    conditions.back().function = state_function("prescribed", options_.prescribed_density, options_.prescribed_velocity,
                                                options_.prescribed_pressure);
  }
  return conditions;
}

std::function<Values<2>(const Vec<2>&, double)> Euler::state_function(const char* what, const std::string& density,
                                                                      const std::string& velocity,
                                                                      const std::string& pressure) const
{
  using expressions::Along, expressions::Expression, expressions::VectorExpression;
  struct Functions {
    std::optional<Expression> density, pressure;
    std::optional<VectorExpression> velocity;
  };
  auto functions = std::make_shared<Functions>();
  const auto compile = [&](const char* part, auto&& make) {
    try {
      make();
    } catch (const expressions::ExpressionError& error) {
      throw Error(Errc::config, fmt::format("{}_{}: {}", what, part, error.what()));
    }
  };
  if (!density.empty()) compile("density", [&] { functions->density.emplace(density); });
  if (!velocity.empty())
    compile("velocity", [&] { functions->velocity.emplace(velocity, Along::components, Eigen::Index{2}); });
  if (!pressure.empty()) compile("pressure", [&] { functions->pressure.emplace(pressure); });
  return [functions, free = free_stream_, name = std::string(what)](const Vec<2>& x, double t) {
    try {
      auto w = free;
      if (functions->density) w[0] = (*functions->density)(x, t);
      if (functions->velocity) {
        const Eigen::VectorXd u = (*functions->velocity)(x, Eigen::Vector2d::Zero(), t);
        w[1] = u[0];
        w[2] = u[1];
      }
      if (functions->pressure) w[3] = (*functions->pressure)(x, t);
      MULLION_REQUIRE(is_gas<2>(w), Errc::numeric,
                      "{}: at ({}, {}) m and t = {} s the density is {} kg/m^3 and the pressure {} Pa; both must be "
                      "positive",
                      name, x.x(), x.y(), t, w[0], w[3]);
      return w;
    } catch (const expressions::ExpressionError& error) {
      throw Error(Errc::numeric, fmt::format("{}: {}", name, error.what()));
    }
  };
}

void Euler::set_first_state(const MeshSource<2>& source, double t)
{
  const auto& geometry = solver_->geometry();
  const auto& order = solver_->mesh().order;
  if (options_.initial_file.empty()) {
    const auto state =
        state_function("initial", options_.initial_density, options_.initial_velocity, options_.initial_pressure);
    set_amounts<2>(
        source, solver_->mesh(), scheme_.gas, geometry.volume, geometry.centroid,
        [&](const Vec<2>& x) { return state(x, t); },
        options_.initial_average == "centroid" ? Average::centroid : Average::quadrature, amounts_);
  } else {
    MULLION_REQUIRE(options_.initial_density.empty() && options_.initial_velocity.empty() &&
                        options_.initial_pressure.empty(),
                    Errc::config, "initial_file and functions for the first state are given; give one of them");
    std::vector<Vec<2>> centroid(order.size()); // as the blocks count
    std::vector<double> volume(order.size());
    for (std::size_t c = 0; c < order.size(); ++c) {
      centroid[static_cast<std::size_t>(order[c])] = geometry.centroid[c];
      volume[static_cast<std::size_t>(order[c])] = geometry.volume[c];
    }
    try {
      const auto saved = saved_state(options_.initial_file, scheme_.gas, source.nodes, centroid, volume);
      for (std::size_t c = 0; c < order.size(); ++c) amounts_[c] = saved[static_cast<std::size_t>(order[c])];
    } catch (const SavedStateError& error) {
      throw Error(Errc::config, std::string("initial_file: ") + error.what());
    }
  }
  write_amounts();
}

void Euler::displace_mesh()
{
  if (options_.initial_mesh_displacement.empty()) return;
  using expressions::Along, expressions::VectorExpression;
  auto nodes = coordinates_.now();
  try {
    const VectorExpression displacement(options_.initial_mesh_displacement, Along::components, Eigen::Index{2});
    for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
      const Eigen::VectorXd x = nodes.col(i);
      nodes.col(i) += displacement(x, Eigen::Vector2d::Zero(), 0.0);
    }
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::config, std::string("initial_mesh_displacement: ") + error.what());
  }
  place(nodes);
}

} // namespace mullion::euler
