// Breaks the rule: a static of the file counts the steps and feeds the result. It outlives every instance.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

namespace mullion::test {
namespace {
int n_steps = 0;
} // namespace

class BadFileStatic final : public OnePointStructure {
public:
  using Options = NoOptions;
  explicit BadFileStatic(const Options&) {}

protected:
  double kept_elsewhere(const TimeStep&, double) override { return 1e-3 * ++n_steps; }
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadFileStatic, "structure", "bad_file_static",
               "test structure with state in a file static");
