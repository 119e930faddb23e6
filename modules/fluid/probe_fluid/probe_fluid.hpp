// The fluid's side of a test of a transfer: exports a given function on a given surface, and measures the motion that
// it gets against another one. No physics, no state.
//
// Window: `wall`, the surface.
#pragma once

#include "expressions/expression.hpp"
#include "probes/sampled_surface.hpp"

#include <mullion/sdk/module.hpp>

#include <optional>
#include <string>

namespace mullion::probe_fluid {

class ProbeFluid final : public Module {
public:
  struct Options {
    std::string mesh;
    std::string group;
    std::string function;
    std::string along = "components";
    std::string on = "load";
    std::string expected_motion;
    bool reverse_normal = false;

    static constexpr auto table()
    {
      return std::tuple{
          required_parameter("mesh", &Options::mesh, "", "a file .msh, .vtk or .vtu, or a generator's text"),
          parameter("group", &Options::group, "", "the mesh's group that is the surface; empty: the whole mesh"),
          parameter("function", &Options::function, "Pa",
                    "traction: expressions of x, y, z, t with ; between them; empty: zero"),
          parameter("along", &Options::along, "", "the function has one part a dimension, or one along the normal",
                    one_of("components", "normal")),
          parameter("on", &Options::on, "",
                    "the field of which force, moment and power are: load, traction on faces, or nodal_traction",
                    one_of("load", "faces", "nodes")),
          parameter("expected_motion", &Options::expected_motion, "",
                    "velocity in m/s, or displacement in m where no velocity is received: one expression a dimension"),
          parameter("reverse_normal", &Options::reverse_normal, "",
                    "normals against those of the elements, which go by the right hand")};
    }
  };

  explicit ProbeFluid(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override { write(step.end, true); }

private:
  void look_up();
  /// All fields, for time t; in define nothing is received yet.
  void write(double t, bool is_received) const;
  void write_resultant() const;
  void write_motion(double t, bool is_received) const;

  Options options_;
  probes::SampledSurface surface_; ///< derived from the window's pane
  std::optional<expressions::VectorExpression> function_, expected_motion_;
  Field traction_, nodal_traction_, load_;
  Field motion_error_l2_, motion_error_max_, area_, force_, moment_, power_;
  Input velocity_, displacement_;
};

} // namespace mullion::probe_fluid
