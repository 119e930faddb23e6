// Breaks the rule: a static of a template keeps the first load that it ever saw. Doing a step twice gives the same
// bits; unloading the library would not clear it; only a fresh process forgets it.
#include "../one_point_structure.hpp"

#include <mullion/sdk/plugin.hpp>

#include <optional>

namespace mullion::test {

template <class T> struct First {
  static inline std::optional<T> value;
};

class BadTemplateStatic final : public OnePointStructure {
public:
  using Options = NoOptions;
  explicit BadTemplateStatic(const Options&) {}

protected:
  double kept_elsewhere(const TimeStep&, double traction) override
  {
    if (!First<double>::value) First<double>::value = traction;
    return *First<double>::value;
  }
};

} // namespace mullion::test

MULLION_PLUGIN(mullion::test::BadTemplateStatic, "structure", "bad_template_static",
               "test structure with state in a template static");
