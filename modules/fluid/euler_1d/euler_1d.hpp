// The fluid module of the one-dimensional piston: windows -> kernels -> windows, no formula in here.
//
// Windows: `volume`, a line of equal cells over [0, length]; `wall`, the point at its right end.
#pragma once

#include "ale_step.hpp"
#include "initial_states.hpp"
#include "wall.hpp"

#include <mullion/sdk/module.hpp>

#include <optional>

namespace mullion::euler_1d {

class Euler1d final : public Module {
public:
  struct Options {
    double length = 1.0;
    int cells = 50;
    double density = 1.3;
    double pressure = 1.0e5;
    double gamma = 1.4;
    std::string left_end = "closed";
    std::string limiter = "none";
    std::string initial = "rest";
    double mode_amplitude = 1.0e-6;
    double mode_angular_frequency = 0.0;
    int substeps = 1;
    double reference_pressure = 0.0;

    static constexpr auto table()
    {
      return std::tuple{
          parameter("length", &Options::length, "m", "undisturbed length L_f of the gas column", above(0.0)),
          parameter("cells", &Options::cells, "1", "number of equal cells", at_least(2)),
          parameter("density", &Options::density, "kg/m^3", "undisturbed density rho_0", above(0.0)),
          parameter("pressure", &Options::pressure, "Pa", "undisturbed pressure p_0", above(0.0)),
          parameter("gamma", &Options::gamma, "1", "ratio of specific heats", above(1.0)),
          parameter("left_end", &Options::left_end, "", "rigid wall, or open to the undisturbed gas",
                    one_of("closed", "open")),
          parameter("limiter", &Options::limiter, "", "of the linear reconstruction; van_albada for shocks",
                    one_of("none", "van_albada"))
              .changeable(),
          parameter("initial", &Options::initial, "", "gas at rest, or an acoustic mode of the coupled problem",
                    one_of("rest", "mode")),
          parameter("mode_amplitude", &Options::mode_amplitude, "m", "initial = mode: wall displacement A"),
          parameter("mode_angular_frequency", &Options::mode_angular_frequency, "rad/s",
                    "initial = mode: eigenvalue omega of the coupled problem", at_least(0.0)),
          parameter("substeps", &Options::substeps, "1", "fluid steps within one coupling step", at_least(1))
              .changeable(),
          parameter("reference_pressure", &Options::reference_pressure, "Pa",
                    "p_ref, subtracted from the exported traction; given in [coupling]")};
    }
  };

  explicit Euler1d(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

private:
  void look_up();
  [[nodiscard]] State working_state() const;
  /// Everything that is recomputed from the state: cell values, totals, wall values.
  void write_first_outputs(double wall_velocity) const;
  void write_outputs(double wall_velocity, double mean_pressure, double work, double impulse) const;

  Options options_;
  AleOptions ale_;
  std::optional<Workspace> workspace_;  ///< scratch: holds nothing from step to step
  std::vector<double> w_begin_, w_end_; ///< scratch
  Field coordinates_, mass_, momentum_, energy_, length_;
  Field density_, velocity_, pressure_, total_mass_, total_energy_;
  Field traction_, traction_mean_, pressure_gradient_, sound_speed_, wall_spacing_, work_, impulse_;
  Input node_velocity_, evaluation_velocity_;
};

} // namespace mullion::euler_1d
