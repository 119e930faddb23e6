// A structure for the closed piston that misbehaves on request: a rigid mass on a spring, one point `wet`, and one
// fault in one of its calls. Without a fault it is a proper module.
//
//   m a = p A - c v - k u  (A = 1 m^2),   v += dt a,   u += dt v      (semi-implicit Euler)
//
// c is read by `step` alone and not declared changeable, the first displacement by `define` alone.
//
// Its second window, `spare`, is there for two of the faults: a window without mercy for memory, and a fixed field
// that is written after all.
#pragma once

#include <mullion/sdk/module.hpp>

#include <string>

namespace mullion::test {

class FaultyStructure final : public Module {
public:
  struct Options {
    double mass = 520.0;
    double stiffness = 1.4e7;
    double damping = 0.0;
    double origin = 1.0;
    double first_displacement = 0.0;
    std::string fault = "none";
    std::string at = "step";
    int at_step = 1;
    double duration = 0.5;

    static constexpr auto table()
    {
      return std::tuple{
          parameter("mass", &Options::mass, "kg", "m", above(0.0)).changeable(),
          parameter("stiffness", &Options::stiffness, "N/m", "k", at_least(0.0)).changeable(),
          parameter("damping", &Options::damping, "N s/m", "c", at_least(0.0)),
          parameter("origin", &Options::origin, "m", "where the wet point lies at rest"),
          parameter("first_displacement", &Options::first_displacement, "m", "u at the start"),
          parameter("fault", &Options::fault, "",
                    "none, throw, throw_foreign, segfault, abort, exit, hang, slow, not_a_number, print, log, "
                    "unwritten, huge, derive, look_back, garbage_window, stray_write, "
                    "stray_write_peer or stray_write_fixed")
              .changeable(),
          parameter("at", &Options::at, "", "the call that misbehaves", one_of("define", "attach", "start", "step"))
              .changeable(),
          parameter("at_step", &Options::at_step, "1", "at = step: in which one; 0: in every one", at_least(0))
              .changeable(),
          parameter("duration", &Options::duration, "s", "fault = slow or derive: how long", at_least(0.0))
              .changeable()};
    }
  };

  explicit FaultyStructure(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

private:
  void look_up();
  void misbehave(const std::string& call, std::int64_t step);

  Options options_;
  bool has_derived_ = false; ///< fault = derive: in its last attach
  double derived_ = 0.0;     ///< u as it was committed then [m]
  Field displacement_, velocity_, acceleration_, work_;
  Input traction_;
};

} // namespace mullion::test
