// A structure without physics, the counterpart of trivial_fluid: velocity = 0.5 * traction + a small number that
// depends on the entry. The velocity is state that every step writes whole. On request it writes a NaN.
#pragma once

#include <mullion/sdk/module.hpp>

namespace mullion::test {

class TrivialStructure final : public Module {
public:
  struct Options {
    int nodes = 10;
    int not_finite_in = 0;
    static constexpr auto table()
    {
      return std::tuple{parameter("nodes", &Options::nodes, "1", "nodes of the wet surface", at_least(1)),
                        parameter("not_finite_in", &Options::not_finite_in, "1",
                                  "the step whose first iteration writes a NaN, last; 0: none", at_least(0))};
    }
  };
  explicit TrivialStructure(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  static constexpr auto functions() { return std::tuple{query("scaled", &TrivialStructure::scaled, "twice a number")}; }

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override;
  double scaled(double number) { return 2.0 * number; }

private:
  Options options_;
  Field velocity_;
  Input traction_;
};

} // namespace mullion::test
