// The structure's side of a test of a transfer: moves a given surface as given functions say, and measures the traction
// or load that it gets against another one. No physics; what it writes depends on the time alone.
//
// Window: `wet`, the surface.
#pragma once

#include "expressions/expression.hpp"
#include "probes/sampled_surface.hpp"

#include <mullion/sdk/module.hpp>

#include <optional>
#include <string>

namespace mullion::probe_structure {

class ProbeStructure final : public Module {
public:
  struct Options {
    std::string mesh;
    std::string group;
    std::string function;
    std::string velocity;
    std::string expected_traction;
    std::string along = "components";
    bool reverse_normal = false;

    static constexpr auto table()
    {
      return std::tuple{
          required_parameter("mesh", &Options::mesh, "", "a file .msh, .vtk or .vtu, or a generator's text"),
          parameter("group", &Options::group, "", "the mesh's group that is the surface; empty: the whole mesh"),
          parameter("function", &Options::function, "",
                    "displacement in m, and velocity in m/s: expressions of x, y, z, t with ; between them, one a "
                    "dimension; empty: zero"),
          parameter("velocity", &Options::velocity, "m/s", "of its own, where it is not that function"),
          parameter("expected_traction", &Options::expected_traction, "Pa", "what should be received"),
          parameter("along", &Options::along, "",
                    "the expected traction has one part a dimension, or one along the normal",
                    one_of("components", "normal")),
          parameter("reverse_normal", &Options::reverse_normal, "",
                    "normals against those of the elements, which go by the right hand")};
    }
  };

  explicit ProbeStructure(const Options& options) : options_(options) {}

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();

  void define(const TimeStep& initial) override;
  void attach() override;
  void step(const TimeStep& step) override { write(step.end, true); }

private:
  void look_up();
  /// All fields, for time t; in define nothing is received yet.
  void write(double t, bool is_received) const;
  void write_received(double t, bool is_received) const;

  Options options_;
  probes::SampledSurface surface_; ///< derived from the window's pane
  std::optional<expressions::VectorExpression> function_, velocity_function_, expected_traction_;
  Field displacement_, velocity_;
  Field load_error_l2_, load_error_max_, area_, force_, moment_, power_;
  Input traction_, load_;
};

} // namespace mullion::probe_structure
