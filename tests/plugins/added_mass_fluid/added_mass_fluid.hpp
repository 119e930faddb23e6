// A fluid of which nothing is left but its added mass, for tests of coupling schemes: windows -> kernel -> windows.
// Together with string_1d it is the model problem of Causin, Gerbeau, Nobile 2005, whose coupled solution is known to
// round-off, and in which one number, the density of the wall, makes weak coupling fail and strong coupling slow.
//
// Window: `wall`, the points (x_i, R). They move up and down only: the x component of what it receives is carried
// along and has no effect. The problem knows steps of one size only, because eta_tt is taken from three displacements.
#pragma once

#include "added_mass.hpp"

#include <mullion/sdk/module.hpp>

#include <vector>

namespace mullion::added_mass_fluid {

class AddedMassFluid final : public Module {
public:
  struct Options {
    int points = 100;
    double length = 6.0;
    double radius = 0.5;
    double density = 1.0;

    static constexpr auto table()
    {
      return std::tuple{
          parameter("points", &Options::points, "1", "points of the wall, without its two fixed ends", at_least(1)),
          parameter("length", &Options::length, "m", "L of the channel", above(0.0)),
          parameter("radius", &Options::radius, "m", "R, from the axis to the wall", above(0.0)),
          parameter("density", &Options::density, "kg/m^3", "rho_f", above(0.0))};
    }
  };

  explicit AddedMassFluid(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override;

private:
  Options options_;
  Channel channel_;
  std::vector<double> matrix_;                         ///< M_A: derived from the parameters alone
  std::vector<double> next_, now_, before_, pressure_; ///< scratch
  Field displacement_, displacement_before_, step_size_, traction_, work_;
  Input received_displacement_;
};

} // namespace mullion::added_mass_fluid
