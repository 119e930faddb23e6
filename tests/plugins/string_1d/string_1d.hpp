// The flexible wall of a channel as a string, for tests of coupling schemes: windows -> kernel -> windows. Together
// with added_mass_fluid it is the model problem of Causin, Gerbeau, Nobile 2005.
//
// Window: `wet`, the points (x_i, R). They move up and down only; what pushes along x has no effect. The problem knows
// steps of one size only, because the inertia is taken from three displacements. What is extensive is for 1 m of depth.
#pragma once

#include "implicit_euler.hpp"

#include <mullion/sdk/module.hpp>

#include <vector>

namespace mullion::string_1d {

class String1d final : public Module {
public:
  struct Options {
    int points = 100;
    double length = 6.0;
    double radius = 0.5;
    double thickness = 0.1;
    double density = 1.1;
    double stiffness = 4.0e5;
    double tension = 2.5e4;
    double pulse_pressure = 2.0e4;
    double pulse_end = 5.0e-3;

    static constexpr auto table()
    {
      return std::tuple{
          parameter("points", &Options::points, "1", "points of the string, without its two fixed ends", at_least(1)),
          parameter("length", &Options::length, "m", "L", above(0.0)),
          parameter("radius", &Options::radius, "m", "R: where the string lies at rest", above(0.0)),
          parameter("thickness", &Options::thickness, "m", "h", above(0.0)),
          parameter("density", &Options::density, "kg/m^3", "rho_s, mass per volume of the wall", above(0.0)),
          parameter("stiffness", &Options::stiffness, "Pa/m", "a, against displacement", at_least(0.0)),
          parameter("tension", &Options::tension, "Pa m", "b", at_least(0.0)),
          parameter("pulse_pressure", &Options::pulse_pressure, "Pa", "p_0 of the pulse around x = 1.5 m"),
          parameter("pulse_end", &Options::pulse_end, "s", "the pulse acts in steps that begin earlier")};
    }
  };

  explicit String1d(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override;

private:
  Options options_;
  ElasticString string_;
  std::vector<double> traction_y_, pressure_, next_, now_, before_, rate_; ///< scratch
  Field displacement_, displacement_before_, velocity_, step_size_, work_, energy_, norm_;
  Input traction_;
};

} // namespace mullion::string_1d
