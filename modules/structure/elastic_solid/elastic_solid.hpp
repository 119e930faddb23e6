// The structure module of an elastic body: windows -> kernels -> windows, no formula in here.
//
// Windows: `volume`, the nodes and elements of the body; `wet`, the faces that a fluid loads, with normals out of the
// body.
#pragma once

#include "boundary.hpp"
#include "duct_radiation.hpp"
#include "modes.hpp"
#include "solid.hpp"
#include "time_integration.hpp"

#include "expressions/expression.hpp"
#include "files/mesh_file.hpp"

#include <mullion/sdk/module.hpp>

#include <optional>

namespace mullion::elastic_solid {

class ElasticSolid final : public Module {
public:
  struct Options {
    std::string mesh, wet, clamped, roller_x, roller_y, roller_z, prescribed, prescribed_displacement;
    std::string edge_load, edge_traction;
    double youngs_modulus = 7.0e10;
    double poisson_ratio = 0.33;
    double density = 2700.0;
    double thickness = 1.0;
    std::string plane = "stress";
    std::string element = "enhanced";
    std::string mass = "consistent";
    std::string integrator = "newmark";
    double beta = 0.25, gamma = 0.5, rho_inf = 0.8;
    double rayleigh_mass = 0.0, rayleigh_stiffness = 0.0;
    int substeps = 1;
    std::string initial = "rest";
    double initial_amplitude = 0.0;
    int initial_mode = 1;
    std::string initial_displacement, initial_velocity;
    std::string monitor;
    bool subtract_steady_load = false;
    int modes = 0;

    static constexpr auto table()
    {
      return std::tuple{
          required_parameter("mesh", &Options::mesh, "",
                             "a file (.msh, .vtk, .vtu) or a generator's text, with groups"),
          required_parameter("wet", &Options::wet, "", "groups that the fluid loads; several with commas between them"),
          parameter("clamped", &Options::clamped, "", "groups whose nodes do not move"),
          parameter("roller_x", &Options::roller_x, "", "groups whose nodes do not move along x"),
          parameter("roller_y", &Options::roller_y, "", "groups whose nodes do not move along y"),
          parameter("roller_z", &Options::roller_z, "", "groups whose nodes do not move along z"),
          parameter("prescribed", &Options::prescribed, "", "groups whose nodes follow prescribed_displacement"),
          parameter("prescribed_displacement", &Options::prescribed_displacement, "m",
                    "\"ux; uy\", functions of x, y, z, t"),
          parameter("edge_load", &Options::edge_load, "", "groups that edge_traction loads, whatever the fluid does"),
          parameter("edge_traction", &Options::edge_traction, "Pa", "\"tx; ty\", functions of x, y, z, t"),
          parameter("youngs_modulus", &Options::youngs_modulus, "Pa", "E", above(0.0)),
          parameter("poisson_ratio", &Options::poisson_ratio, "1", "nu",
                    Range{.lower = -1.0, .upper = 0.5, .excludes_lower = true, .excludes_upper = true}),
          parameter("density", &Options::density, "kg/m^3", "mass per reference volume", above(0.0)),
          parameter("thickness", &Options::thickness, "m", "of the plane, in 2D", above(0.0)),
          parameter("plane", &Options::plane, "", "in 2D: a thin plate, or a slice of a long body",
                    one_of("stress", "strain")),
          parameter("element", &Options::element, "",
                    "standard, or quadrilaterals and hexahedra with enhanced strains, which do not lock in bending",
                    one_of("standard", "enhanced")),
          parameter("mass", &Options::mass, "", "matrix", one_of("consistent", "lumped")),
          parameter("integrator", &Options::integrator, "",
                    "newmark and generalised_alpha (implicit), central_difference (explicit), or static: no inertia",
                    one_of("newmark", "generalised_alpha", "central_difference", "static")),
          parameter("beta", &Options::beta, "1", "of newmark", between(0.0, 0.5)),
          parameter("gamma", &Options::gamma, "1", "of newmark; above 1/2 it damps, with first order",
                    between(0.5, 1.0)),
          parameter("rho_inf", &Options::rho_inf, "1",
                    "of generalised_alpha: what a step leaves of the highest frequencies", between(0.0, 1.0)),
          parameter("rayleigh_mass", &Options::rayleigh_mass, "1/s", "a_0 of the damping a_0 M + a_1 K", at_least(0.0)),
          parameter("rayleigh_stiffness", &Options::rayleigh_stiffness, "s", "a_1 of the damping a_0 M + a_1 K",
                    at_least(0.0)),
          parameter("substeps", &Options::substeps, "1", "structural steps within one coupling step", at_least(1)),
          parameter("initial", &Options::initial, "",
                    "rest; static_pressure: as a uniform pressure on the wet surface bends it; expressions; mode",
                    one_of("rest", "static_pressure", "expressions", "mode")),
          parameter("initial_amplitude", &Options::initial_amplitude, "m",
                    "static_pressure: displacement at monitor along the wet surface's normal; mode: largest component"),
          parameter("initial_mode", &Options::initial_mode, "1", "which mode to start in; 1 is the lowest",
                    at_least(1)),
          parameter("initial_displacement", &Options::initial_displacement, "m", "expressions: \"ux; uy\" of x, y, z"),
          parameter("initial_velocity", &Options::initial_velocity, "m/s", "expressions: \"vx; vy\" of x, y, z"),
          parameter("monitor", &Options::monitor, "m",
                    "\"x, y\": the node nearest to it is recorded; if left out, the wet one nearest to their centre"),
          parameter("subtract_steady_load", &Options::subtract_steady_load, "",
                    "take the first load that is received off every later one"),
          parameter("modes", &Options::modes, "1",
                    "lowest modes that are found and logged; of the first six, modal_coordinate is recorded",
                    at_least(0))};
    }
  };

  explicit ElasticSolid(const Options& options);

  static std::vector<FieldSpec> fields();
  static std::vector<InputSpec> inputs();
  static constexpr auto functions()
  {
    return std::tuple{
        query("max_dt", &ElasticSolid::max_dt, "largest stable coupling step of the integrator [s]"),
        query("frequency", &ElasticSolid::frequency, "of a mode without a load [Hz]; 1 is the lowest"),
        query("vacuum_frequency", &ElasticSolid::vacuum_frequency,
              "lowest frequency without a load [Hz], as the integrator runs it in coupling steps of so many s"),
        query("write_mesh", &ElasticSolid::write_mesh, "with its groups, in Gmsh's format, to an open file; bytes"),
        query("list_boundaries", &ElasticSolid::list_boundaries,
              "faces and names of its groups, to an open file; lines"),
        query("radiation_rate", &ElasticSolid::radiation_rate,
              "growth of a mode [1/s], below 0, by the waves that its wet surface, a part of the floor, sends along a "
              "duct: mode, height [m], speed along x [m/s], density [kg/m^3], speed of sound [m/s]"),
        query("radiation_shift", &ElasticSolid::radiation_shift,
              "what the gas of that duct adds to the mode's frequency [Hz]; takes the same")};
  }

  void define(const TimeStep& initial) override;
  void attach() override;
  void start(const TimeStep& initial) override;
  void step(const TimeStep& step) override;

  double max_dt();
  double frequency(double mode);
  double vacuum_frequency(double step);
  double write_mesh(double file);
  double list_boundaries(double file);
  double radiation_rate(double mode, double height, double speed, double density, double sound_speed);
  double radiation_shift(double mode, double height, double speed, double density, double sound_speed);

private:
  void make_windows();
  void look_up();
  void build();
  void set_initial(const TimeStep& initial);

  [[nodiscard]] bool is_static() const { return options_.integrator == "static"; }
  [[nodiscard]] bool is_explicit() const { return options_.integrator == "central_difference"; }
  [[nodiscard]] NewmarkParameters newmark_parameters() const;
  const FreeSolver& stiffness_solver();
  const FreeSolver& mass_solver();
  const Modes& modes();
  /// As many of the lowest modes as `mode` says, or more. @throws Error naming `function`
  Modes modes_to(double mode, const char* function);
  [[nodiscard]] Radiation radiation(const char* function, double mode, const Duct& duct);

  [[nodiscard]] Motion working_motion() const;
  /// Overwrite the entries that are not free.
  void hold(const Eigen::VectorXd& given, Eigen::Ref<Eigen::VectorXd> values) const;
  /// Where the body is held or moved at t; derivatives as central differences over the structural step.
  [[nodiscard]] Given given_at(double t, double dt) const;
  /// What is received at t, as loads on the wet nodes [N]; zero without a connection.
  [[nodiscard]] Eigen::MatrixXd received_load(double t);
  [[nodiscard]] bool is_mean_load() const;
  /// Of the wet nodes and of edge_traction at t, on all degrees of freedom [N].
  [[nodiscard]] Eigen::VectorXd all_loads(const Eigen::MatrixXd& wet_load, double t) const;
  void advance(const Eigen::VectorXd& begin, const Eigen::VectorXd& end, bool is_mean, const TimeStep& substep);
  void write_outputs(const Eigen::MatrixXd& wet_load, double t, double work, const Eigen::VectorXd& impulse);

  Options options_;

  // Derived: a function of parameters and windows.
  Solid solid_;
  System system_;
  SparseMatrix stress_matrix_; ///< of the displacements
  std::vector<bool> is_held_;  ///< of the degrees of freedom: not free
  std::vector<Index> moved_nodes_;
  Surface wet_surface_; ///< of the wet nodes
  Eigen::VectorX<Index> wet_nodes_;
  SparseMatrix wet_mass_, edge_mass_; ///< nodal tractions to loads, of the wet nodes and of all
  Eigen::Index monitor_ = 0;
  std::optional<expressions::VectorExpression> prescribed_displacement_, edge_traction_;
  std::optional<FreeSolver> stiffness_solver_, mass_solver_;
  std::optional<Newmark> newmark_;
  std::optional<Modes> modes_;
  std::optional<double> critical_step_;

  Field displacement_, velocity_, acceleration_, position_, stress_, von_mises_, shear_stress_, energy_,
      modal_coordinate_;
  Field monitor_displacement_;
  Field wet_displacement_, wet_velocity_, wet_acceleration_, applied_load_, steady_load_, work_, impulse_;
  Input traction_, load_;
};

} // namespace mullion::elastic_solid
