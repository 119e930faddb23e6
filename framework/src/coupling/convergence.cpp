#include <mullion/coupling/convergence.hpp>

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>

namespace mullion {

namespace {
constexpr double largest_growth = 1e6; // of a change, against the step's first
} // namespace

void Convergence::begin_step(const TimeStep& step)
{
  step_ = step;
  for (auto& field : fields_) field = {};
}

void Convergence::compare(std::size_t field, int iteration, const Values& now, const Values& before)
{
  auto& last = fields_[field];
  const auto& tolerance = tolerances_[field];
  last.change = (now - before).norm();
  last.size = now.norm();
  const bool is_finite = std::isfinite(last.change) && std::isfinite(last.size);
  const double allowed = tolerance.absolute + tolerance.relative * last.size;
  if (is_finite && !last.has_first && last.change > allowed) { // from rest a field's first change may be round-off
    last.first_change = last.change;
    last.has_first = true;
  }
  last.has_passed = is_finite && last.change <= allowed;
  const bool has_grown = last.has_first && !last.has_passed && last.change > largest_growth * last.first_change;
  if (is_finite && !has_grown) return;
  Eigen::Index component = 0, entity = 0;
  double largest = -1.0;
  for (Eigen::Index j = 0; j < now.cols() && std::isfinite(largest); ++j)
    for (Eigen::Index i = 0; i < now.rows(); ++i) {
      const double moved = std::abs(now(i, j) - before(i, j));
      if (moved <= largest) continue; // NaN compares false: it is taken
      largest = moved, component = i, entity = j;
      if (!std::isfinite(moved)) break;
    }
  throw Error(Errc::numeric,
              fmt::format("the iteration has diverged: in step {} (t = {} s), iteration {}, the {} changed by {:.3e}, "
                          "{} in the first; most "
                          "at [{}, {}] (component, entity), from {} to {}; a smaller relaxation, or acceleration = "
                          "\"iqn_ils\", may help",
                          step_.index, step_.begin, iteration + 1, tolerance.field, last.change,
                          fmt::format("{:.3e}", last.first_change), component, entity, before(component, entity),
                          now(component, entity)));
}

bool Convergence::is_reached() const
{
  for (const auto& field : fields_)
    if (!field.has_passed) return false;
  return true;
}

std::string Convergence::describe() const
{
  std::string text;
  for (std::size_t f = 0; f < fields_.size(); ++f)
    text += fmt::format("{}{} changed by {:.3e}, {:.3e} allowed", f == 0 ? "" : "; ", tolerances_[f].field,
                        fields_[f].change, tolerances_[f].absolute + tolerances_[f].relative * fields_[f].size);
  return text;
}

} // namespace mullion
