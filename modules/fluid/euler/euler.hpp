// The fluid module for the plane: windows -> kernels -> windows, no formula in here.
//
// Windows: `volume`, all cells and nodes; `wall`, the faces of the groups that a structure moves, and their nodes.
#pragma once

#include "initial.hpp"
#include "patches.hpp"
#include "solver.hpp"
#include "wall.hpp"

#include "expressions/expression.hpp"

#include <mullion/sdk/module.hpp>

#include <memory>
#include <optional>

namespace mullion::euler {

class Euler final : public Module {
public:
  struct Options {
    std::string mesh;
    std::string moving_wall, slip_wall, symmetry, farfield, prescribed;
    std::string subsonic_inflow, subsonic_outflow, supersonic_inflow, supersonic_outflow, periodic;
    double density = 1.3, pressure = 1.0e5, velocity_x = 0.0, velocity_y = 0.0, mach = 0.0, gamma = 1.4;
    double total_pressure = 0.0, total_temperature = 0.0, gas_constant = 287.05, outflow_pressure = 0.0;
    std::string prescribed_density, prescribed_velocity, prescribed_pressure;
    std::string initial_density, initial_velocity, initial_pressure, initial_average = "centroid", initial_file;
    std::string initial_mesh_displacement;
    std::string flux = "hllc", limiter = "none", integrator = "jameson";
    int order = 2;
    double limiter_k = 5.0, limiter_length = 1.0;
    std::string time_stepping = "global";
    int substeps = 1;
    double cfl_warn = 1.25, cfl_max = 1.35, cfl = 1.2;
    int steady_iterations = 0, first_order_iterations = 0, iterations_per_step = 1;
    std::string gradient = "second_order", wall_velocity = "end";
    int threads = 1;
    double reference_pressure = 0.0;

    using O = Options;
    static constexpr auto boundary_table()
    {
      return std::tuple{
          required_parameter("mesh", &O::mesh, "", "file (.msh, .vtk, .vtu) or generator, say \"box:40x20\""),
          parameter("moving_wall", &O::moving_wall, "", "groups that a structure moves, with commas; window wall"),
          parameter("slip_wall", &O::slip_wall, "", "groups that are walls without friction"),
          parameter("symmetry", &O::symmetry, "", "groups that are planes of symmetry"),
          parameter("farfield", &O::farfield, "", "groups that are open to the free stream"),
          parameter("prescribed", &O::prescribed, "", "groups with a state that is prescribed"),
          parameter("subsonic_inflow", &O::subsonic_inflow, "", "groups with a total pressure and temperature"),
          parameter("subsonic_outflow", &O::subsonic_outflow, "", "groups with a static pressure"),
          parameter("supersonic_inflow", &O::supersonic_inflow, "", "groups where the free stream comes in"),
          parameter("supersonic_outflow", &O::supersonic_outflow, "", "groups where the gas leaves"),
          parameter("periodic", &O::periodic, "", "pairs of groups, say \"x_min:x_max, y_min:y_max\"")};
    }
    static constexpr auto gas_table()
    {
      return std::tuple{
          parameter("density", &O::density, "kg/m^3", "of the free stream", above(0.0)),
          parameter("pressure", &O::pressure, "Pa", "of the free stream", above(0.0)),
          parameter("velocity_x", &O::velocity_x, "m/s", "of the free stream"),
          parameter("velocity_y", &O::velocity_y, "m/s", "of the free stream"),
          parameter("mach", &O::mach, "1", "of the free stream along x, instead of its velocity", at_least(0.0)),
          parameter("gamma", &O::gamma, "1", "ratio of specific heats", above(1.0)),
          parameter("total_pressure", &O::total_pressure, "Pa", "subsonic_inflow; 0: the free stream's", at_least(0.0)),
          parameter("total_temperature", &O::total_temperature, "K", "subsonic_inflow; 0: the free stream's",
                    at_least(0.0)),
          parameter("gas_constant", &O::gas_constant, "J/(kg K)", "R in p = rho R T, for total_temperature",
                    above(0.0)),
          parameter("outflow_pressure", &O::outflow_pressure, "Pa", "subsonic_outflow; 0: the free stream's",
                    at_least(0.0)),
          parameter("prescribed_density", &O::prescribed_density, "",
                    "function of x, y, t in kg/m^3; empty: the free stream's"),
          parameter("prescribed_velocity", &O::prescribed_velocity, "",
                    "functions \"u; v\" in m/s; empty: the free stream's"),
          parameter("prescribed_pressure", &O::prescribed_pressure, "", "function in Pa; empty: the free stream's"),
          parameter("initial_density", &O::initial_density, "",
                    "function of x, y, t in kg/m^3; empty: the free stream's"),
          parameter("initial_velocity", &O::initial_velocity, "",
                    "functions \"u; v\" in m/s; empty: the free stream's"),
          parameter("initial_pressure", &O::initial_pressure, "", "function in Pa; empty: the free stream's"),
          parameter("initial_mesh_displacement", &O::initial_mesh_displacement, "",
                    "functions \"dx; dy\" of x, y in m: where the mesh stands at first, from where it was made"),
          parameter("initial_average", &O::initial_average, "",
                    "value of a cell: at its centroid, or the mean over it by quadrature",
                    one_of("centroid", "quadrature")),
          parameter("initial_file", &O::initial_file, "",
                    "first state from a table (.csv: x,y,rho,u,v,p) or from a file of results (.h5)")};
    }
    static constexpr auto scheme_table()
    {
      return std::tuple{
          parameter("flux", &O::flux, "", "between cells", one_of("hllc", "roe")),
          parameter("order", &O::order, "1", "in space", between(1, 2)),
          parameter("limiter", &O::limiter, "", "of the gradients; for shocks",
                    one_of("none", "venkatakrishnan", "barth_jespersen")),
          parameter("limiter_k", &O::limiter_k, "1", "venkatakrishnan's K: 0.3 for shocks, 5 for smooth flows",
                    at_least(0.0)),
          parameter("limiter_length", &O::limiter_length, "m", "L_ref in venkatakrishnan's (K h / L_ref)^3",
                    above(0.0)),
          parameter("integrator", &O::integrator, "", "four stages: Jameson's or the classical Runge-Kutta",
                    one_of("jameson", "rk4")),
          parameter("time_stepping", &O::time_stepping, "",
                    "one time step for all cells, or each its own, towards a steady state", one_of("global", "local")),
          parameter("substeps", &O::substeps, "1", "fluid steps within one coupling step", at_least(1)),
          parameter("cfl_warn", &O::cfl_warn, "1", "Courant number from which there is a warning", above(0.0)),
          parameter("cfl_max", &O::cfl_max, "1", "Courant number beyond which the run ends", above(0.0)),
          parameter("cfl", &O::cfl, "1", "local time steps: Courant number of each cell", above(0.0)),
          parameter("steady_iterations", &O::steady_iterations, "1",
                    "so many with local time steps before the run, on the mesh at rest: it starts from a steady flow",
                    at_least(0)),
          parameter("first_order_iterations", &O::first_order_iterations, "1",
                    "local time steps: so many of the iterations first, before the second order", at_least(0)),
          parameter("iterations_per_step", &O::iterations_per_step, "1", "time_stepping = local: of the step",
                    at_least(1)),
          parameter("gradient", &O::gradient, "",
                    "of the pressure at the wall: through wall and cells, or the cell's own",
                    one_of("second_order", "cell")),
          parameter("wall_velocity", &O::wall_velocity, "",
                    "that goes with the exported pressure, unless the driver says: at the step's end, or of the "
                    "last substep",
                    one_of("end", "substep")),
          parameter("threads", &O::threads, "1", "of this module; results do not depend on it", between(1, 256)),
          parameter("reference_pressure", &O::reference_pressure, "Pa",
                    "p_ref, subtracted from the exported traction; given in [coupling]")};
    }
    static constexpr auto table() { return std::tuple_cat(boundary_table(), gas_table(), scheme_table()); }
  };

  explicit Euler(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();
  static constexpr auto functions()
  {
    return std::tuple{
        query("max_dt", &Euler::max_dt, "largest step at the last committed state [s]"),
        query("write_mesh", &Euler::write_mesh, "with its groups, in Gmsh's format, to an open file; bytes"),
        query("list_boundaries", &Euler::list_boundaries, "faces and names of its groups, to an open file; lines")};
  }

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;
  double max_dt();
  double write_mesh(double file);
  double list_boundaries(double file);

private:
  using NodeArray = Eigen::Matrix2Xd;
  /// What one step did to the wall, by face, and its Courant number.
  struct StepSums {
    std::vector<double> mean_pressure;
    Vec<2> impulse = Vec<2>::Zero();
    double work = 0.0, courant = 0.0;
  };

  void look_up();
  void build(const MeshSource<2>& source);
  [[nodiscard]] MeshSource<2> source_of_windows() const;
  [[nodiscard]] std::vector<Condition<2>> conditions() const;
  [[nodiscard]] std::function<Values<2>(const Vec<2>&, double)> state_function(const char* what,
                                                                               const std::string& density,
                                                                               const std::string& velocity,
                                                                               const std::string& pressure) const;
  void displace_mesh();
  void settle(double t); ///< towards a steady flow, before the first step
  void set_first_state(const MeshSource<2>& source, double t);
  void read_amounts(bool committed);
  void write_amounts();
  void iterate(const TimeStep& step, const NodeArray& nodes, StepSums& sums);
  void place(const NodeArray& nodes); ///< unless the resting mesh is there already
  void write_outputs(const TimeStep& step, const StepSums& sums, const NodeArray& wall_velocity);
  void add_substep(StepSums& sums, double part) const;
  void require(const Outcome<2>& outcome, const NodeArray& nodes, double dt) const;
  [[nodiscard]] std::string place_of(Index cell, const NodeArray& nodes) const;

  Options options_;
  Patches patches_;
  Scheme<2> scheme_;
  Values<2> free_stream_{};

  std::unique_ptr<Solver<2>> solver_;
  std::vector<Index> wall_faces_;      ///< numbers of boundary faces, in the window's order
  NodeArray placed_;                   ///< where the nodes of the resting mesh are; empty: nowhere yet
  std::vector<Values<2>> amounts_;     ///< scratch
  NodeArray v_begin_, v_end_, v_mean_; ///< scratch
  mutable bool has_warned_ = false;    ///< of the Courant number, once an instance

  Field coordinates_, mass_, momentum_, energy_, first_residual_;
  Field density_, velocity_, pressure_, mach_, total_mass_, total_energy_, residual_, max_cfl_;
  Field traction_, traction_mean_, pressure_gradient_, normal_, sound_speed_, wall_spacing_;
  Field wall_pressure_, nodal_traction_, nodal_traction_mean_, load_, load_mean_, work_, impulse_, force_;
  Input node_velocity_, evaluation_velocity_;
};

} // namespace mullion::euler
