// A fluid without physics on a plane mesh of both kinds of elements that moves as a given function of time, for what
// draws meshes: each node is lifted by amplitude * x * t, the pressure is 100 kPa plus 1 kPa times the element's
// number, the residual falls by a factor of ten a step.
#pragma once

#include <mullion/sdk/module.hpp>

namespace mullion::test {

class WavingFluid final : public Module {
public:
  struct Options {
    int cells = 4;
    double amplitude = 0.25;
    static constexpr auto table()
    {
      return std::tuple{parameter("cells", &Options::cells, "1",
                                  "squares of 1 m along x; half as many along y, the "
                                  "upper ones cut into two triangles",
                                  at_least(2)),
                        parameter("amplitude", &Options::amplitude, "1/s", "lift of a node by x and t")};
    }
  };
  explicit WavingFluid(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override;

private:
  void fill(const TimeStep& step);

  Options options_;
  Coordinates reference_; ///< derived: the pane's
  Field coordinates_, velocity_, pressure_, residual_;
};

} // namespace mullion::test
