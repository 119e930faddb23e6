// The structure module of the one-dimensional piston: windows -> kernels -> windows, no formula in here.
//
// Windows: `body`, the line of bar elements; `wet`, the loaded end (node 0) as a point.
#pragma once

#include "newmark.hpp"

#include <mullion/sdk/module.hpp>

#include <optional>

namespace mullion::elastic_bar {

class ElasticBar final : public Module {
public:
  struct Options {
    double density = 2600.0;
    double youngs_modulus = 2.8e6;
    double length = 0.2;
    double area = 1.0;
    int elements = 10;
    double origin = 1.0;
    std::string far_end = "clamped";
    std::string integrator = "newmark";
    std::string initial = "rest";
    double mode_amplitude = 1.0e-6;
    double mode_angular_frequency = 0.0;
    int substeps = 1;

    static constexpr auto table()
    {
      return std::tuple{
          parameter("density", &Options::density, "kg/m^3", "mass per reference volume", above(0.0)).changeable(),
          parameter("youngs_modulus", &Options::youngs_modulus, "Pa", "E_s", above(0.0)).changeable(),
          parameter("length", &Options::length, "m", "L_s", above(0.0)),
          parameter("area", &Options::area, "m^2", "cross-section", above(0.0)),
          parameter("elements", &Options::elements, "1", "number of equal linear elements", at_least(1)),
          parameter("origin", &Options::origin, "m", "where the loaded end lies at rest"),
          parameter("far_end", &Options::far_end, "", "the end that carries no load", one_of("clamped", "free")),
          parameter("integrator", &Options::integrator, "",
                    "newmark (average acceleration, implicit) or central_difference (explicit)",
                    one_of("newmark", "central_difference")),
          parameter("initial", &Options::initial, "", "at rest, or a mode of the coupled problem",
                    one_of("rest", "mode")),
          parameter("mode_amplitude", &Options::mode_amplitude, "m", "initial = mode: displacement of the loaded end"),
          parameter("mode_angular_frequency", &Options::mode_angular_frequency, "rad/s",
                    "initial = mode: eigenvalue omega of the coupled problem", at_least(0.0)),
          parameter("substeps", &Options::substeps, "1", "structural steps within one coupling step", at_least(1))
              .changeable()};
    }
  };

  explicit ElasticBar(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();
  static constexpr auto functions()
  {
    return std::tuple{query("max_dt", &ElasticBar::max_dt, "largest stable step of the integrator [s]"),
                      query("vacuum_frequency", &ElasticBar::vacuum_frequency,
                            "lowest frequency without a load [Hz], as the integrator runs it in coupling steps of so "
                            "many s")};
  }

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

  double max_dt();
  double vacuum_frequency(double step);

private:
  void look_up();
  [[nodiscard]] Motion working_motion() const;
  /// F on node 0, along +x, at time t [N].
  [[nodiscard]] double load_at(double t);
  [[nodiscard]] bool is_mean_load();
  void write_outputs(double load, double work, double impulse) const;

  Options options_;
  Bar bar_;
  std::optional<Newmark> newmark_; ///< a function of bar and dt alone
  Field displacement_, velocity_, acceleration_, energy_;
  Field wet_displacement_, wet_velocity_, wet_acceleration_, applied_load_, work_, impulse_;
  Input traction_, load_;
};

} // namespace mullion::elastic_bar
