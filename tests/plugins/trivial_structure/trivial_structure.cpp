#include "trivial_structure.hpp"

#include <limits>

namespace mullion::test {
namespace {

double offset(std::size_t entry) { return 1e-3 * static_cast<double>(entry % 5); }

} // namespace

std::vector<FieldSpec> TrivialStructure::fields()
{
  return {state("wet", "velocity", Location::node, vector, "m/s", "velocity of the wet surface").overwritten()};
}

std::vector<InputSpec> TrivialStructure::inputs()
{
  return {receive("wet", "traction", Location::node, vector, "Pa", "traction of the fluid")};
}

void TrivialStructure::define(const TimeStep&)
{
  Coordinates points = Coordinates::Zero(3, options_.nodes);
  for (int i = 0; i < options_.nodes; ++i) points(0, i) = i;
  make_window("wet", {point_pane(points)});
  const auto velocity = flat(field("wet", "velocity").now());
  for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] = offset(k);
}

void TrivialStructure::attach()
{
  velocity_ = field("wet", "velocity");
  traction_ = input("wet", "traction");
}

void TrivialStructure::step(const TimeStep& step)
{
  const auto traction = flat(traction_.newest());
  const auto velocity = flat(velocity_.now());
  for (std::size_t k = 0; k < velocity.size(); ++k) velocity[k] = 0.5 * traction[k] + offset(k);
  if (step.index == options_.not_finite_in && step.iteration == 0)
    velocity.back() = std::numeric_limits<double>::quiet_NaN();
}

} // namespace mullion::test
