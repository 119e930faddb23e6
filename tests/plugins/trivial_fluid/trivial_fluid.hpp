// A fluid without physics, for tests of the coupling itself: traction = 0.5 * velocity + a small number that depends
// on the entry, so that a value in the wrong place, of the wrong step or never written shows. On request it writes a
// NaN, or fails over one that it receives.
#pragma once

#include <mullion/sdk/module.hpp>

#include <string>

namespace mullion::test {

class TrivialFluid final : public Module {
public:
  struct Options {
    int nodes = 10;
    int not_finite_in = 0;
    std::string on_nan = "compute";
    static constexpr auto table()
    {
      return std::tuple{parameter("nodes", &Options::nodes, "1", "nodes of the wall", at_least(1)),
                        parameter("not_finite_in", &Options::not_finite_in, "1",
                                  "the step that writes a NaN, last; 0: none", at_least(0)),
                        parameter("on_nan", &Options::on_nan, "", "what to do where the velocity is NaN",
                                  one_of("compute", "throw", "abort"))};
    }
  };
  explicit TrivialFluid(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override;

private:
  Options options_;
  Field traction_;
  Input velocity_;
};

} // namespace mullion::test
