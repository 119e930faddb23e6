// Breaks the rule: a member counts the steps and feeds the result.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {

class BadMember final : public OnePointStructure {
public:
  using Options = NoOptions;
  explicit BadMember(const Options&) {}

protected:
  double kept_elsewhere(const TimeStep&, double) override { return 1e-3 * ++n_steps_; }

private:
  int n_steps_ = 0;
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadMember, "structure", "bad_member", "test structure with state in a member");
