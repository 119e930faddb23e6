// Breaks the rule: an operator that was assembled from the state of the first step, and is used ever after, is state,
// not derived data. Doing a step twice gives the same bits; a fresh process assembles another one.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

#include <optional>

namespace mullion::test {

class BadCachedOperator final : public OnePointStructure {
public:
  using Options = NoOptions;
  explicit BadCachedOperator(const Options&) {}

protected:
  double kept_elsewhere(const TimeStep&, double traction) override
  {
    if (!secant_) secant_ = 1.0 / (1.0 + traction);
    return *secant_ * 1e-3;
  }

private:
  std::optional<double> secant_;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadCachedOperator, "structure", "bad_cached_operator",
               "test structure with an operator of an earlier time");
