// A fluid without physics, for tests of the coupling itself: traction = 0.5 * velocity + a small number that depends
// on the entry, so that a value in the wrong place, of the wrong step or never written shows.
#pragma once

#include <mullion/sdk/module.hpp>

namespace mullion::test {

class TrivialFluid final : public Module {
public:
  struct Options {
    int nodes = 10;
    static constexpr auto table()
    {
      return std::tuple{parameter("nodes", &Options::nodes, "1", "nodes of the wall", at_least(1))};
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
