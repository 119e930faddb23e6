#include "trivial_fluid.hpp"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace mullion::test {
namespace {

double offset(std::size_t entry) { return 1e-3 * static_cast<double>(entry % 7); }

} // namespace

std::vector<FieldSpec> TrivialFluid::fields()
{
  return {output("wall", "traction", Location::node, vector, "Pa", "traction on the structure")};
}

std::vector<InputSpec> TrivialFluid::inputs()
{
  return {receive("wall", "velocity", Location::node, vector, "m/s", "velocity of the wall")};
}

void TrivialFluid::define(const TimeStep&)
{
  Coordinates points = Coordinates::Zero(3, options_.nodes);
  for (int i = 0; i < options_.nodes; ++i) points(0, i) = i;
  make_window("wall", {point_pane(points)});
  const auto traction = flat(field("wall", "traction").now());
  for (std::size_t k = 0; k < traction.size(); ++k) traction[k] = offset(k);
}

void TrivialFluid::attach()
{
  traction_ = field("wall", "traction");
  velocity_ = input("wall", "velocity");
}

void TrivialFluid::step(const TimeStep& step)
{
  const auto velocity = flat(velocity_.newest());
  const auto traction = flat(traction_.now());
  for (std::size_t k = 0; k < traction.size(); ++k) {
    if (options_.on_nan == "throw" && std::isnan(velocity[k])) throw std::runtime_error("cannot go on with a NaN");
    if (options_.on_nan == "abort" && std::isnan(velocity[k])) std::abort();
    traction[k] = 0.5 * velocity[k] + offset(k);
  }
  if (step.index == options_.not_finite_in) traction.back() = std::numeric_limits<double>::quiet_NaN();
}

} // namespace mullion::test
