// Mesh motion of the one-dimensional piston: node velocities from the wall's. It keeps no state at all.
//
// Windows: `volume`, the fluid's mesh; `wall`, the fluid's wall point, where the velocity is received.
#pragma once

#include <mullion/sdk/module.hpp>

#include <vector>

namespace mullion::stretch_1d {

class Stretch1d final : public Module {
public:
  struct Options {
    static constexpr auto table() { return std::tuple{}; }
  };
  explicit Stretch1d(const Options&) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override { step(initial); }
  void step(const TimeStep& step) override;

private:
  std::vector<double> xi_; ///< derived from the reference coordinates
  Field velocity_;
  Input wall_velocity_;
};

} // namespace mullion::stretch_1d
