// Breaks the rule: it remembers when it was called last and takes the difference for the time step.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class BadCachedTime final : public OnePointStructure {
public:
  using Options = NoOptions;
  explicit BadCachedTime(const Options&) {}

protected:
  double kept_elsewhere(const TimeStep& step, double) override
  {
    const double dt = step.end - last_time_;
    last_time_ = step.end;
    return dt;
  }

private:
  double last_time_ = 0.0;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadCachedTime, "structure", "bad_cached_time", "test structure with a cached time");
