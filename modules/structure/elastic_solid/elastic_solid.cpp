#include "elastic_solid.hpp"

#include "body.hpp"
#include "initial_states.hpp"

#include "files/file_error.hpp"
#include "files/read.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace mullion::elastic_solid {
namespace {

constexpr int n_recorded_modes = 6; ///< components of modal_coordinate

using Vector = Eigen::Map<Eigen::VectorXd, Eigen::Aligned64>;

/// The array of a field, one entry a degree of freedom.
Vector dofs(Array array) { return {array.data(), array.size()}; }

expressions::VectorExpression compiled(const char* parameter, const std::string& text, Eigen::Index dimension)
{
  try {
    return {text, expressions::Along::components, dimension};
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::config, fmt::format("{}: {}", parameter, error.what()));
  }
}

Eigen::VectorXd evaluated(const expressions::VectorExpression& f, const Eigen::VectorXd& x, double t)
{
  try {
    return f(x, {}, t);
  } catch (const expressions::ExpressionError& error) {
    throw Error(Errc::numeric, error.what());
  }
}

/// "x, y" as a point.
Eigen::VectorXd point_in(const std::string& text, Eigen::Index dimension)
{
  Eigen::VectorXd x(dimension);
  const auto names = names_in(text);
  bool is_right = names.size() == static_cast<std::size_t>(dimension);
  for (std::size_t i = 0; is_right && i < names.size(); ++i) {
    char* end = nullptr;
    x[static_cast<Eigen::Index>(i)] = std::strtod(names[i].c_str(), &end);
    is_right = *end == '\0' && std::isfinite(x[static_cast<Eigen::Index>(i)]);
  }
  MULLION_REQUIRE(is_right, Errc::config, "monitor = \"{}\": it is a point of {} numbers with commas between them",
                  text, dimension);
  return x;
}

Eigen::Index nearest(const Eigen::MatrixXd& nodes, const Eigen::VectorXd& x)
{
  Eigen::Index best = 0;
  for (Eigen::Index i = 1; i < nodes.cols(); ++i)
    if ((nodes.col(i) - x).squaredNorm() < (nodes.col(best) - x).squaredNorm()) best = i;
  return best;
}

} // namespace

ElasticSolid::ElasticSolid(const Options& options) : options_(options)
{
  const auto& o = options;
  MULLION_REQUIRE(o.integrator != "newmark" || o.beta > 0.0, Errc::config,
                  "beta = 0 with integrator = \"newmark\" is the explicit method: take \"central_difference\"");
  MULLION_REQUIRE(o.prescribed.empty() == o.prescribed_displacement.empty(), Errc::config,
                  "prescribed (groups) and prescribed_displacement (a function) need each other; the case has one");
  MULLION_REQUIRE(o.edge_load.empty() == o.edge_traction.empty(), Errc::config,
                  "edge_load (groups) and edge_traction (a function) need each other; the case has one");
  MULLION_REQUIRE((o.initial == "static_pressure" || o.initial == "mode") || o.initial_amplitude == 0.0, Errc::config,
                  "initial_amplitude belongs to initial = \"static_pressure\" or \"mode\", not to \"{}\"", o.initial);
  MULLION_REQUIRE(o.initial == "expressions" || (o.initial_displacement.empty() && o.initial_velocity.empty()),
                  Errc::config, "initial_displacement and initial_velocity need initial = \"expressions\"");
}

std::vector<FieldSpec> ElasticSolid::fields()
{
  using enum Location;
  const char *v = "volume", *w = "wet";
  return {
      fixed(v, "constraints", node, scalar, "1", "sum of 1, 2, 4: held along x, y, z; 8: moved as prescribed")
          .integer(),
      fixed(v, "loaded_faces", element, scalar, "1", "sum of 2^k for each face k that edge_traction loads").integer(),
      state(v, "displacement", node, vector, "m", "u"),
      state(v, "velocity", node, vector, "m/s", "v"),
      state(v, "acceleration", node, vector, "m/s^2", "a, as the integrator goes on with it"),
      output(v, "position", node, vector, "m", "reference coordinates and displacement"),
      output(v, "stress", element, 6, "Pa", "xx, yy, zz, xy, yz, zx at the centre"),
      output(v, "von_mises", element, scalar, "Pa", "equivalent stress at the centre"),
      output(v, "shear_stress", element, scalar, "Pa", "stress xy at the centre, by itself"),
      output(v, "energy", pane, scalar, "J", "kinetic and elastic"),
      output(v, "modal_coordinate", pane, n_recorded_modes, "m kg^(1/2)",
             "phi_k^T M u of the lowest modes, phi_k^T M phi_k = 1; 0 beyond the parameter modes"),
      output(v, "monitor_displacement", pane, vector, "m", "u of the monitored node"),
      fixed(w, "volume_node", node, scalar, "1", "number in volume").integer(),
      state(w, "displacement", node, vector, "m", "u").overwritten(),
      state(w, "velocity", node, vector, "m/s", "v").overwritten(),
      state(w, "acceleration", node, vector, "m/s^2", "a, in balance with the load of the last step").overwritten(),
      state(w, "applied_load", node, vector, "N", "as the last step used it, at its end").extensive().overwritten(),
      state(w, "steady_load", node, vector, "N", "what is taken off every load that is received").extensive(),
      output(w, "work", pane, scalar, "J", "of the load in this step"),
      output(w, "impulse", pane, vector, "N s", "of the load in this step"),
  };
}

std::vector<InputSpec> ElasticSolid::inputs()
{
  return {
      receive("wet", "traction", Location::node, vector, "Pa", "acts on the solid; linear between the nodes")
          .optional(),
      receive("wet", "load", Location::node, vector, "N", "instead of a traction").extensive().optional(),
  };
}

// ---- life ----------------------------------------------------------------------------------------------------------

void ElasticSolid::define(const TimeStep& initial)
{
  make_windows();
  look_up();
  build();
  set_initial(initial);
  steady_load_.now().setZero();
  write_outputs(Eigen::MatrixXd::Zero(solid_.dimension(), wet_nodes_.size()), initial.end, 0.0,
                Eigen::VectorXd::Zero(solid_.dimension()));
}

void ElasticSolid::attach()
{
  look_up();
  build();
}

void ElasticSolid::start(const TimeStep& initial)
{
  Eigen::MatrixXd load = received_load(initial.end);
  if (options_.subtract_steady_load) {
    steady_load_.now() = load;
    load.setZero();
  }
  auto motion = working_motion();
  const auto given = given_at(initial.end, initial.dt / options_.substeps);
  const auto loads = all_loads(load, initial.end);
  if (is_static()) {
    motion.displacement = static_displacement(system_, stiffness_solver(), loads, given.displacement);
  } else { // the first acceleration is in balance with the first load, which only the driver knows
    motion.acceleration = given.acceleration;
    balance_acceleration(system_, mass_solver(), motion, loads);
  }
  write_outputs(load, initial.end, 0.0, Eigen::VectorXd::Zero(solid_.dimension()));
  if (options_.modes == 0) return;
  const auto& found = modes();
  std::string list;
  for (int k = 0; k < options_.modes; ++k)
    list += fmt::format("{}{:.6g}", k == 0 ? "" : ", ", found.angular_frequencies[k] / (2.0 * std::numbers::pi));
  log().info("lowest frequencies without a load: {} Hz", list);
}

void ElasticSolid::step(const TimeStep& step)
{
  const int n = options_.substeps;
  const double dt = step.dt / n;
  MULLION_REQUIRE(!is_explicit() || dt <= max_dt() / n, Errc::numeric,
                  "a structural step of {} s is beyond the stability limit {} s of central_difference; use more "
                  "substeps, larger elements or integrator = \"newmark\"",
                  dt, max_dt() / n);
  const auto u = dofs(displacement_.now());
  const Eigen::Index d = solid_.dimension();
  const bool is_mean = is_mean_load();
  double work = 0.0;
  Eigen::VectorXd impulse = Eigen::VectorXd::Zero(d);
  Eigen::MatrixXd before = applied_load_.committed(), load = before;
  double t_before = step.begin;
  for (int m = 1; m <= n; ++m) {
    const double t = m == n ? step.end : step.begin + m * dt;
    load = received_load(t) - steady_load_.now();
    const Eigen::VectorXd u_before = u;
    const Eigen::MatrixXd at_begin = is_mean ? load : before;
    advance(all_loads(at_begin, t_before), all_loads(load, t), is_mean && !(load == before && m > 1),
            {step.index, t_before, t, dt, step.iteration});
    for (Eigen::Index i = 0; i < wet_nodes_.size(); ++i)
      for (Eigen::Index k = 0; k < d; ++k) {
        const double mean = 0.5 * (at_begin(k, i) + load(k, i)); // to the bit the load, if that is the mean
        const auto dof = wet_nodes_[i] * d + k;
        work += mean * (u[dof] - u_before[dof]);
        impulse[k] += mean * dt;
      }
    before = load;
    t_before = t;
  }
  write_outputs(load, step.end, work, impulse);
}

void ElasticSolid::advance(const Eigen::VectorXd& begin, const Eigen::VectorXd& end, bool is_mean,
                           const TimeStep& substep)
{
  auto motion = working_motion();
  const auto given = given_at(substep.end, substep.dt);
  if (is_static()) {
    motion.displacement = static_displacement(system_, stiffness_solver(), end, given.displacement);
    return;
  }
  // A load that is constant over the step jumps at its begin: so does the acceleration, or it would ring.
  if (is_mean) balance_acceleration(system_, mass_solver(), motion, begin);
  if (is_explicit()) {
    central_difference_step(system_, mass_solver(), motion, substep.dt, end, given);
    return;
  }
  if (!newmark_ || newmark_->dt() != substep.dt) newmark_.emplace(system_, newmark_parameters(), substep.dt);
  newmark_->step(system_, motion, begin, end, given);
}

// ---- windows -------------------------------------------------------------------------------------------------------

void ElasticSolid::make_windows()
{
  const auto& o = options_;
  Body body;
  bool is_read = false; // what goes wrong before says the mesh's name itself
  try {
    const auto mesh = mesh_files::read_or_generate(o.mesh);
    is_read = true;
    body = body_of(mesh, {o.wet, o.clamped, o.roller_x, o.roller_y, o.roller_z, o.prescribed, o.edge_load});
  } catch (const mesh_files::FileError& error) {
    throw Error(Errc::config, (is_read ? fmt::format("mesh = \"{}\": ", o.mesh) : "") + error.what());
  }
  const auto pane_of = [](const Eigen::MatrixXd& nodes, const std::vector<mesh_files::Block>& blocks) {
    Pane pane{0, nodes, {}};
    for (const auto& [shape, connectivity] : blocks)
      pane.blocks.push_back({static_cast<ElementType>(shape), connectivity}); // the numbers are the same
    return pane;
  };
  const auto n_wet = static_cast<Eigen::Index>(body.wet_nodes.size());
  const Eigen::VectorX<Index> wet_nodes = Eigen::Map<const Eigen::VectorX<Index>>(body.wet_nodes.data(), n_wet);
  make_window("volume", {pane_of(body.nodes, body.blocks)});
  make_window("wet", {pane_of(body.nodes(Eigen::all, wet_nodes), body.wet)});
  field("wet", "volume_node").index_now() = wet_nodes.transpose();
  field("volume", "constraints").index_now() = body.constraints.transpose();
  field("volume", "loaded_faces").index_now() = body.loaded_faces.transpose();
}

void ElasticSolid::look_up()
{
  displacement_ = field("volume", "displacement");
  velocity_ = field("volume", "velocity");
  acceleration_ = field("volume", "acceleration");
  position_ = field("volume", "position");
  stress_ = field("volume", "stress");
  von_mises_ = field("volume", "von_mises");
  shear_stress_ = field("volume", "shear_stress");
  energy_ = field("volume", "energy");
  modal_coordinate_ = field("volume", "modal_coordinate");
  monitor_displacement_ = field("volume", "monitor_displacement");
  wet_displacement_ = field("wet", "displacement");
  wet_velocity_ = field("wet", "velocity");
  wet_acceleration_ = field("wet", "acceleration");
  applied_load_ = field("wet", "applied_load");
  steady_load_ = field("wet", "steady_load");
  work_ = field("wet", "work");
  impulse_ = field("wet", "impulse");
  traction_ = input("wet", "traction");
  load_ = input("wet", "load");
}

void ElasticSolid::build()
{
  const auto blocks_of = [](const Pane& pane) {
    std::vector<mesh_files::Block> blocks;
    for (const auto& [type, connectivity] : pane.blocks) blocks.push_back({static_cast<Shape>(type), connectivity});
    return blocks;
  };
  const auto volume = pane("volume"), wet = pane("wet");
  const Eigen::Index d = volume.coordinates.rows();
  solid_ = {.nodes = volume.coordinates,
            .blocks = blocks_of(volume),
            .material = {options_.youngs_modulus, options_.poisson_ratio, options_.density,
                         options_.plane == "stress" ? Plane::stress : Plane::strain},
            .formulation = options_.element == "enhanced" ? Formulation::enhanced : Formulation::standard,
            .thickness = d == 2 ? options_.thickness : 1.0};
  system_ = {.stiffness = stiffness_matrix(solid_),
             .mass = mass_matrix(solid_, options_.mass == "lumped" ? MassKind::lumped : MassKind::consistent),
             .rayleigh_mass = options_.rayleigh_mass,
             .rayleigh_stiffness = options_.rayleigh_stiffness};

  stress_matrix_ = stress_matrix(solid_);

  const auto constraints = field("volume", "constraints").indices();
  is_held_.assign(static_cast<std::size_t>(solid_.n_dofs()), false);
  moved_nodes_.clear();
  for (Eigen::Index i = 0; i < solid_.n_nodes(); ++i) {
    const bool is_moved = (constraints(0, i) & prescribed_bit) != 0;
    if (is_moved) moved_nodes_.push_back(static_cast<Index>(i));
    for (Eigen::Index k = 0; k < d; ++k) {
      const bool is_held = is_moved || (constraints(0, i) & held_bits[k]) != 0;
      is_held_[static_cast<std::size_t>(i * d + k)] = is_held;
      if (!is_held) system_.free.push_back(static_cast<Index>(i * d + k));
    }
  }
  if (is_static() || options_.initial == "static_pressure") {
    const auto missing = missing_support(solid_, is_held_);
    MULLION_REQUIRE(missing.empty(), Errc::config, "{}: {}; clamp a group, or add rollers",
                    is_static() ? "integrator = \"static\"" : "initial = \"static_pressure\"", missing);
  }

  wet_surface_ = surface_of_blocks(blocks_of(wet));
  wet_mass_ = solid_.thickness * surface_mass(wet.coordinates, wet_surface_);
  wet_nodes_ = field("wet", "volume_node").indices().row(0).transpose();
  const Eigen::VectorX<Index> loaded = field("volume", "loaded_faces").indices().row(0).transpose();
  edge_mass_ = solid_.thickness * surface_mass(solid_.nodes, surface_of(solid_, faces_in(loaded)));
  if (!options_.prescribed.empty())
    prescribed_displacement_ = compiled("prescribed_displacement", options_.prescribed_displacement, d);
  if (!options_.edge_load.empty()) edge_traction_ = compiled("edge_traction", options_.edge_traction, d);
  monitor_ = options_.monitor.empty() ? wet_nodes_[nearest(wet.coordinates, wet.coordinates.rowwise().mean())]
                                      : nearest(solid_.nodes, point_in(options_.monitor, d));
  stiffness_solver_.reset();
  mass_solver_.reset();
  newmark_.reset();
  modes_.reset();
  critical_step_.reset();
}

const FreeSolver& ElasticSolid::stiffness_solver()
{
  if (!stiffness_solver_) stiffness_solver_.emplace(system_.stiffness, system_.free);
  return *stiffness_solver_;
}

const FreeSolver& ElasticSolid::mass_solver()
{
  if (!mass_solver_) mass_solver_.emplace(system_.mass, system_.free);
  return *mass_solver_;
}

const Modes& ElasticSolid::modes()
{
  if (!modes_) {
    const int n_started = options_.initial == "mode" ? options_.initial_mode : 1;
    modes_ = lowest_modes(system_, std::max(options_.modes, n_started)); // a number of the parameters alone
    MULLION_REQUIRE(modes_->complaint.empty(), Errc::config, "modal analysis: {}", modes_->complaint);
  }
  return *modes_;
}

NewmarkParameters ElasticSolid::newmark_parameters() const
{
  if (options_.integrator == "generalised_alpha") return generalised_alpha(options_.rho_inf);
  if (options_.integrator == "central_difference") return {.beta = 0.0};
  return {.beta = options_.beta, .gamma = options_.gamma};
}

// ---- state, loads --------------------------------------------------------------------------------------------------

Motion ElasticSolid::working_motion() const
{
  return {dofs(displacement_.now()), dofs(velocity_.now()), dofs(acceleration_.now())};
}

void ElasticSolid::set_initial(const TimeStep& initial)
{
  const double t = initial.end;
  auto motion = working_motion();
  motion.displacement.setZero();
  motion.velocity.setZero();
  motion.acceleration.setZero();
  const Eigen::Index d = solid_.dimension();
  if (options_.initial == "static_pressure") {
    const auto wet = pane("wet");
    const auto at_wet = nodal_normals(wet.coordinates, wet_surface_);
    Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(d, solid_.n_nodes());
    normals(Eigen::all, wet_nodes_) = at_wet;
    const Eigen::VectorXd along = at_wet.col(nearest(wet.coordinates, solid_.nodes.col(monitor_))).normalized();
    motion.displacement = pressure_shape(stiffness_solver(), normals, monitor_, along, options_.initial_amplitude);
    MULLION_REQUIRE(options_.initial_amplitude == 0.0 || !motion.displacement.isZero(0.0), Errc::config,
                    "initial = \"static_pressure\": a pressure on the wet surface does not move the node at {} along "
                    "the normal; choose another monitor",
                    place(solid_.nodes.col(monitor_)));
  } else if (options_.initial == "mode") {
    motion.displacement = scaled_shape(modes().shapes.col(options_.initial_mode - 1), options_.initial_amplitude);
  } else if (options_.initial == "expressions") {
    const auto u = compiled("initial_displacement", options_.initial_displacement, d);
    const auto v = compiled("initial_velocity", options_.initial_velocity, d);
    for (Eigen::Index i = 0; i < solid_.n_nodes(); ++i) {
      motion.displacement.segment(i * d, d) = evaluated(u, solid_.nodes.col(i), t);
      motion.velocity.segment(i * d, d) = evaluated(v, solid_.nodes.col(i), t);
    }
  }
  const auto given = given_at(t, initial.dt / options_.substeps);
  hold(given.displacement, motion.displacement);
  hold(given.velocity, motion.velocity);
}

void ElasticSolid::hold(const Eigen::VectorXd& given, Eigen::Ref<Eigen::VectorXd> values) const
{
  for (Eigen::Index i = 0; i < values.size(); ++i)
    if (is_held_[static_cast<std::size_t>(i)]) values[i] = given[i];
}

Given ElasticSolid::given_at(double t, double dt) const
{
  const Eigen::Index d = solid_.dimension();
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(solid_.n_dofs());
  Given given{zero, zero, zero};
  const auto constraints = field("volume", "constraints").indices();
  for (const Index i : moved_nodes_) {
    const Eigen::VectorXd x = solid_.nodes.col(i), before = evaluated(*prescribed_displacement_, x, t - dt),
                          now = evaluated(*prescribed_displacement_, x, t),
                          after = evaluated(*prescribed_displacement_, x, t + dt);
    for (Eigen::Index k = 0; k < d; ++k) {
      if ((constraints(0, i) & held_bits[k]) != 0) continue; // clamped as well: it stays
      // To central differences these are the velocity and the acceleration; to the others as good as the step.
      given.displacement[i * d + k] = now[k];
      given.velocity[i * d + k] = (after[k] - before[k]) / (2.0 * dt);
      given.acceleration[i * d + k] = (after[k] - 2.0 * now[k] + before[k]) / (dt * dt);
    }
  }
  return given;
}

Eigen::MatrixXd ElasticSolid::received_load(double t)
{
  MULLION_REQUIRE(!traction_.is_connected() || !load_.is_connected(), Errc::config,
                  "it receives a traction or a load, one of them; the driver connects both");
  if (load_.is_connected()) return load_.at(t);
  if (traction_.is_connected()) return traction_.at(t) * wet_mass_; // S is symmetric
  return Eigen::MatrixXd::Zero(solid_.dimension(), wet_nodes_.size());
}

bool ElasticSolid::is_mean_load() const
{
  return traction_.is_connected() ? traction_.is_mean() : load_.is_connected() && load_.is_mean();
}

Eigen::VectorXd ElasticSolid::all_loads(const Eigen::MatrixXd& wet_load, double t) const
{
  const Eigen::Index d = solid_.dimension();
  Eigen::MatrixXd load = Eigen::MatrixXd::Zero(d, solid_.n_nodes());
  if (edge_traction_) {
    Eigen::MatrixXd traction = Eigen::MatrixXd::Zero(d, solid_.n_nodes());
    for (Eigen::Index i = 0; i < solid_.n_nodes(); ++i)
      if (edge_mass_.outerIndexPtr()[i + 1] > edge_mass_.outerIndexPtr()[i]) // a node of a loaded face
        traction.col(i) = evaluated(*edge_traction_, solid_.nodes.col(i), t);
    load = traction * edge_mass_;
  }
  for (Eigen::Index i = 0; i < wet_nodes_.size(); ++i) load.col(wet_nodes_[i]) += wet_load.col(i);
  return load.reshaped();
}

void ElasticSolid::write_outputs(const Eigen::MatrixXd& wet_load, double t, double work, const Eigen::VectorXd& impulse)
{
  auto motion = working_motion();
  const Eigen::Index d = solid_.dimension();
  const Eigen::MatrixXd u = displacement_.now();
  position_.now() = solid_.nodes + u;
  auto stress = stress_.now();
  dofs(stress) = stress_matrix_ * u.reshaped();
  auto equivalent = von_mises_.now();
  for (Eigen::Index e = 0; e < stress.cols(); ++e) equivalent(0, e) = von_mises(stress.col(e));
  shear_stress_.now() = stress.row(3); // a picture of a report shows a scalar
  energy_.now()(0, 0) = energy(system_.mass, motion.velocity) + energy(system_.stiffness, motion.displacement);
  auto q = modal_coordinate_.now();
  q.setZero();
  if (options_.modes > 0)
    q.topRows(std::min(options_.modes, n_recorded_modes)) =
        modal_coordinates(modes(), system_.mass, motion.displacement).head(std::min(options_.modes, n_recorded_modes));
  monitor_displacement_.now() = u.col(monitor_);

  // What generalised alpha goes on with belongs to a time within the step; what others read is in balance at its end.
  Eigen::VectorXd a = motion.acceleration;
  if (options_.integrator == "generalised_alpha") {
    Eigen::VectorXd moving = motion.displacement, v = motion.velocity;
    balance_acceleration(system_, mass_solver(), {moving, v, a}, all_loads(wet_load, t));
  }
  wet_displacement_.now() = u(Eigen::all, wet_nodes_);
  wet_velocity_.now() = velocity_.now()(Eigen::all, wet_nodes_);
  wet_acceleration_.now() = a.reshaped(d, solid_.n_nodes())(Eigen::all, wet_nodes_);
  applied_load_.now() = wet_load;
  work_.now()(0, 0) = work;
  impulse_.now() = impulse;
}

} // namespace mullion::elastic_solid
