// The module: windows -> kernel -> windows, no formula in here. All that it needs in order to go on stands in its
// window; its members are parameters and handles.
//
// Window: `wet`, one point, where the gas pushes.
#pragma once

#include "oscillator.hpp"

#include <mullion/sdk/module.hpp>

namespace mullion::spring_mass {

class SpringMass final : public Module {
public:
  struct Options {
    double mass = 100.0;
    double stiffness = 4.0e6;
    double area = 1.0;
    double origin = 1.0;

    static constexpr auto table()
    {
      return std::tuple{parameter("mass", &Options::mass, "kg", "of the rigid body", above(0.0)),
                        parameter("stiffness", &Options::stiffness, "N/m", "of the spring", at_least(0.0)),
                        parameter("area", &Options::area, "m^2", "on which the traction acts", above(0.0)),
                        parameter("origin", &Options::origin, "m", "where the wet point lies at rest")};
    }
  };

  explicit SpringMass(const Options& options) : options_(options), body_{options.mass, options.stiffness} {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

private:
  void look_up();
  /// F at time t [N].
  [[nodiscard]] double load_at(double t);
  void write(const Motion& motion) const;

  Options options_;
  Oscillator body_;
  Field displacement_, velocity_, acceleration_, energy_;
  Input traction_;
};

} // namespace mullion::spring_mass
