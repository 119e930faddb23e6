#include "euler.hpp"

#include "mesh_input.hpp"

#include "files/file_error.hpp"
#include "files/hand_out.hpp"
#include "files/read.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

/// The kernels' errors as Mullion's.
template <class Body> auto with_code(Errc code, Body&& body)
{
  try {
    return body();
  } catch (const MeshError& error) {
    throw Error(code, error.what());
  } catch (const mesh_files::FileError& error) {
    throw Error(code, error.what());
  } catch (const expressions::ExpressionError& error) {
    throw Error(code, error.what());
  }
}

/// The wall's boundary faces, as the window has them: as the blocks count.
std::vector<Index> wall_faces_of(const Mesh<2>& mesh, int n_moving)
{
  std::vector<Index> faces;
  for (std::size_t b = 0; b < mesh.boundary.size(); ++b)
    if (mesh.boundary[b].patch < n_moving) faces.push_back(static_cast<Index>(b));
  const auto key = [&](Index b) {
    const auto& origin = mesh.boundary[static_cast<std::size_t>(b)].origin;
    return std::pair(origin.cell, origin.face);
  };
  std::sort(faces.begin(), faces.end(), [&](Index l, Index r) { return key(l) < key(r); });
  return faces;
}

ElementType element_type(Shape shape) { return static_cast<ElementType>(static_cast<std::uint32_t>(shape)); }

} // namespace

Euler::Euler(const Options& options) : options_(options)
{
  patches_ = with_code(Errc::config, [&] {
    return patches_of({options.moving_wall, options.slip_wall, options.symmetry, options.farfield, options.prescribed,
                       options.subsonic_inflow, options.subsonic_outflow, options.supersonic_inflow,
                       options.supersonic_outflow, options.periodic});
  });
  MULLION_REQUIRE(options.mach == 0.0 || (options.velocity_x == 0.0 && options.velocity_y == 0.0), Errc::config,
                  "mach = {} and a velocity of the free stream are given; give one of them", options.mach);
  scheme_.gas.gamma = options.gamma;
  const double sound = std::sqrt(options.gamma * options.pressure / options.density);
  free_stream_ = {options.density, options.mach > 0.0 ? options.mach * sound : options.velocity_x, options.velocity_y,
                  options.pressure};
  scheme_.flux = options.flux == "hllc" ? Flux::hllc : Flux::roe;
  scheme_.order = options.order;
  scheme_.integrator = options.integrator == "jameson" ? Integrator::jameson : Integrator::rk4;
  scheme_.limiter = {options.limiter == "none"              ? Limiter::none
                     : options.limiter == "venkatakrishnan" ? Limiter::venkatakrishnan
                                                            : Limiter::barth_jespersen,
                     options.limiter_k,
                     options.limiter_length,
                     {options.density, sound, sound, options.pressure}};
}

std::vector<FieldSpec> Euler::fields()
{
  using enum Location;
  return {
      state("volume", "coordinates", node, vector, "m", "where the nodes are"),
      state("volume", "mass", element, scalar, "kg", "in each cell, per metre of depth").extensive(),
      state("volume", "momentum", element, vector, "kg m/s", "in each cell, per metre of depth").extensive(),
      state("volume", "energy", element, scalar, "J", "in each cell, per metre of depth").extensive(),
      state("volume", "first_residual", pane, scalar, "kg/(m^3 s)", "time_stepping = local: of the first iteration"),
      output("volume", "density", element, scalar, "kg/m^3", "cell mean"),
      output("volume", "velocity", element, vector, "m/s", "of the cell's mass"),
      output("volume", "pressure", element, scalar, "Pa", "absolute"),
      output("volume", "mach", element, scalar, "1", "Mach number"),
      output("volume", "total_mass", pane, scalar, "kg", "of all cells, per metre of depth"),
      output("volume", "total_energy", pane, scalar, "J", "of all cells, per metre of depth"),
      output("volume", "residual", pane, scalar, "1",
             "time_stepping = local: L2 norm of the change of density, relative to the first iteration's"),
      output("volume", "max_cfl", pane, scalar, "1", "largest Courant number of the step"),
      fixed("volume", "face_patch", element, 4, "1", "number of the patch of each face, -1 within the mesh").integer(),
      fixed("volume", "boundary_groups", node, scalar, "1", "bit k: on the k-th boundary group, by name").integer(),
      output("wall", "traction", element, vector, "Pa", "(p - p_ref) n_f at the end of the step, n_f out of the fluid"),
      output("wall", "traction_mean", element, vector, "Pa",
             "the same with the mean pressure over the step, as the scheme integrates it"),
      output("wall", "pressure", element, scalar, "Pa", "on the wall at the end of the step, absolute"),
      output("wall", "pressure_gradient", element, scalar, "Pa/m", "dp/dn_f at the end of the step"),
      output("wall", "sound_speed", element, scalar, "m/s", "at the end of the step"),
      output("wall", "wall_spacing", element, scalar, "m", "dx_n: twice the distance of the cell's centroid"),
      output("wall", "normal", element, vector, "1", "n_f, of length 1, at the end of the step"),
      output("wall", "nodal_traction", node, vector, "Pa", "mean of the adjacent faces' traction, by length"),
      output("wall", "nodal_traction_mean", node, vector, "Pa", "the same of traction_mean"),
      output("wall", "load", node, vector, "N", "half of the adjacent faces' force, per metre of depth").extensive(),
      output("wall", "load_mean", node, vector, "N", "the same of traction_mean").extensive(),
      output("wall", "work", pane, scalar, "J", "work of (p - p_ref) on the wall in this step, per metre of depth"),
      output("wall", "impulse", pane, vector, "N s", "of (p - p_ref) n_f on the wall in this step, per metre of depth"),
      output("wall", "force", pane, vector, "N", "of (p - p_ref) n_f on the wall, per metre of depth"),
      fixed("wall", "volume_node", node, scalar, "1", "number of the node in volume").integer(),
  };
}

std::vector<InputSpec> Euler::inputs()
{
  return {
      receive("volume", "velocity", Location::node, vector, "m/s", "node velocity, at both ends of the step")
          .optional(),
      receive("wall", "evaluation_velocity", Location::node, vector, "m/s",
              "wall velocity that goes with the exported pressure; default: that of the step's end")
          .optional(),
  };
}

void Euler::define(const TimeStep& initial)
{
  const auto source = with_code(
      Errc::config, [&] { return source_of<2>(mesh_files::read_or_generate(options_.mesh, 2), patches_.names); });
  auto with_pairs = source;
  with_pairs.periodic = patches_.periodic;
  build(with_pairs);
  const auto& mesh = solver_->mesh();

  Pane volume{0, source.nodes, {}};
  for (const auto& block : source.blocks) volume.blocks.push_back({element_type(block.shape), block.connectivity});
  std::vector<Index> wall_nodes;
  for (const Index b : wall_faces_)
    for (const Index node : mesh.boundary_nodes(b)) wall_nodes.push_back(node);
  std::sort(wall_nodes.begin(), wall_nodes.end());
  wall_nodes.erase(std::unique(wall_nodes.begin(), wall_nodes.end()), wall_nodes.end());
  const auto n_wall_nodes = static_cast<Eigen::Index>(wall_nodes.size());
  Pane wall{0, Coordinates(2, n_wall_nodes), {}};
  for (Eigen::Index i = 0; i < n_wall_nodes; ++i)
    wall.coordinates.col(i) = source.nodes.col(wall_nodes[static_cast<std::size_t>(i)]);
  Connectivity lines(2, static_cast<Eigen::Index>(wall_faces_.size()));
  for (std::size_t f = 0; f < wall_faces_.size(); ++f)
    for (std::size_t k = 0; k < 2; ++k)
      lines(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(f)) = static_cast<Index>(
          std::lower_bound(wall_nodes.begin(), wall_nodes.end(), mesh.boundary_nodes(wall_faces_[f])[k]) -
          wall_nodes.begin());
  if (!wall_faces_.empty()) wall.blocks.push_back({ElementType::line2, lines});
  make_window("volume", {volume});
  make_window("wall", {wall});
  look_up();
  field("volume", "face_patch").index_now() = source.patch_of_face;
  const auto bits = group_bits(mesh, patches_.names, mesh.n_nodes);
  auto groups = field("volume", "boundary_groups").index_now();
  for (std::size_t i = 0; i < bits.size(); ++i) groups(0, static_cast<Eigen::Index>(i)) = bits[i];
  auto volume_node = field("wall", "volume_node").index_now();
  for (Eigen::Index i = 0; i < n_wall_nodes; ++i) volume_node(0, i) = wall_nodes[static_cast<std::size_t>(i)];

  coordinates_.now() = source.nodes;
  displace_mesh();
  first_residual_.now()(0, 0) = 0.0;
  auto displaced = source;
  displaced.nodes = coordinates_.values();
  set_first_state(displaced, initial.end);
  settle(initial.end);
  StepSums sums;
  write_outputs(initial, sums, NodeArray::Zero(2, source.nodes.cols()));
}

void Euler::attach()
{
  look_up();
  if (!solver_) build(source_of_windows());
}

void Euler::start(const TimeStep& initial)
{
  if (!node_velocity_.is_connected()) return;
  read_amounts(false);
  write_outputs(initial, {}, node_velocity_.at(initial.end)); // define could not know how the wall moves
}

void Euler::look_up()
{
  coordinates_ = field("volume", "coordinates");
  mass_ = field("volume", "mass");
  momentum_ = field("volume", "momentum");
  energy_ = field("volume", "energy");
  first_residual_ = field("volume", "first_residual");
  density_ = field("volume", "density");
  velocity_ = field("volume", "velocity");
  pressure_ = field("volume", "pressure");
  mach_ = field("volume", "mach");
  total_mass_ = field("volume", "total_mass");
  total_energy_ = field("volume", "total_energy");
  residual_ = field("volume", "residual");
  max_cfl_ = field("volume", "max_cfl");
  traction_ = field("wall", "traction");
  traction_mean_ = field("wall", "traction_mean");
  wall_pressure_ = field("wall", "pressure");
  pressure_gradient_ = field("wall", "pressure_gradient");
  normal_ = field("wall", "normal");
  sound_speed_ = field("wall", "sound_speed");
  wall_spacing_ = field("wall", "wall_spacing");
  nodal_traction_ = field("wall", "nodal_traction");
  nodal_traction_mean_ = field("wall", "nodal_traction_mean");
  load_ = field("wall", "load");
  load_mean_ = field("wall", "load_mean");
  work_ = field("wall", "work");
  impulse_ = field("wall", "impulse");
  force_ = field("wall", "force");
  node_velocity_ = input("volume", "velocity");
  evaluation_velocity_ = input("wall", "evaluation_velocity");
}

MeshSource<2> Euler::source_of_windows() const
{
  const auto volume = pane("volume");
  MeshSource<2> source;
  source.nodes = volume.coordinates;
  for (const auto& block : volume.blocks)
    source.blocks.push_back({static_cast<Shape>(static_cast<std::uint32_t>(block.type)), block.connectivity});
  source.patch_of_face = field("volume", "face_patch").indices();
  source.periodic = patches_.periodic;
  return source;
}

void Euler::build(const MeshSource<2>& source)
{
  solver_ = with_code(Errc::config, [&] {
    return std::make_unique<Solver<2>>(build_mesh(source), conditions(), scheme_, options_.threads);
  });
  const auto& mesh = solver_->mesh();
  wall_faces_ = wall_faces_of(mesh, patches_.n_moving);
  amounts_.resize(mesh.n_cells);
  const auto outcome = solver_->place(source.nodes);
  MULLION_REQUIRE(outcome.kind == Outcome<2>::Kind::fine, Errc::shape,
                  "{} has an area of {} m^2: a cell needs some, and its nodes go round it counterclockwise",
                  place_of(outcome.cell, source.nodes), outcome.value);
  placed_ = source.nodes;
}

void Euler::read_amounts(bool committed)
{
  const auto mass = committed ? mass_.committed() : mass_.values();
  const auto momentum = committed ? momentum_.committed() : momentum_.values();
  const auto energy = committed ? energy_.committed() : energy_.values();
  const auto& order = solver_->mesh().order;
  for (std::size_t c = 0; c < order.size(); ++c) {
    const Index e = order[c];
    amounts_[c] = {mass(0, e), momentum(0, e), momentum(1, e), energy(0, e)};
  }
}

void Euler::write_amounts()
{
  auto mass = mass_.now(), momentum = momentum_.now(), energy = energy_.now();
  const auto& order = solver_->mesh().order;
  for (std::size_t c = 0; c < order.size(); ++c) {
    const Index e = order[c];
    const auto& a = amounts_[c];
    mass(0, e) = a[0];
    momentum(0, e) = a[1];
    momentum(1, e) = a[2];
    energy(0, e) = a[3];
  }
}

void Euler::step(const TimeStep& step)
{
  auto coordinates = coordinates_.now();
  const bool is_moving = node_velocity_.is_connected();
  read_amounts(false);
  StepSums sums;
  sums.mean_pressure.assign(wall_faces_.size(), 0.0);
  v_mean_.setZero(2, coordinates.cols());
  if (options_.time_stepping == "local") {
    MULLION_REQUIRE(!is_moving, Errc::config,
                    "time_stepping = \"local\" is for a resting mesh, but it receives a node "
                    "velocity; use \"global\"");
    iterate(step, coordinates, sums);
  } else {
    const int n = options_.substeps;
    const double dt = step.dt / n;
    if (is_moving) v_end_ = node_velocity_.at(step.begin);
    else place(coordinates);
    for (int m = 1; m <= n; ++m) {
      const double begin = step.begin + (m - 1) * dt;
      Outcome<2> outcome;
      if (is_moving) {
        v_begin_.swap(v_end_);
        v_end_ = node_velocity_.at(m == n ? step.end : step.begin + m * dt);
        v_mean_ = 0.5 * (v_begin_ + v_end_);
        outcome = solver_->advance_moving(amounts_, begin, dt, coordinates, v_mean_, options_.cfl_max);
      } else {
        outcome = solver_->advance(amounts_, begin, dt, coordinates, options_.cfl_max);
      }
      require(outcome, coordinates, dt);
      sums.courant = std::max(sums.courant, outcome.courant);
      if (is_moving) coordinates += dt * v_mean_;
      add_substep(sums, 1.0 / n);
    }
    if (is_moving) placed_.resize(2, 0); // the solver's geometry is that of the last substep's begin
  }
  write_amounts();
  if (is_moving && options_.wall_velocity == "end") v_mean_ = v_end_;
  if (evaluation_velocity_.is_connected()) {
    const auto w = evaluation_velocity_.newest();
    const auto volume_node = field("wall", "volume_node").indices();
    for (Eigen::Index i = 0; i < w.cols(); ++i) v_mean_.col(volume_node(0, i)) = w.col(i);
  }
  write_outputs(step, sums, v_mean_);
}

void Euler::settle(double t)
{
  if (options_.steady_iterations == 0) return;
  const NodeArray nodes = coordinates_.values();
  double first = 0.0;
  for (int i = 0; i < options_.steady_iterations; ++i) {
    solver_->set_order(i < options_.first_order_iterations ? 1 : options_.order);
    require(solver_->iterate(amounts_, t, options_.cfl, nodes), nodes, 0.0);
    if (!(first > 0.0)) first = solver_->residual();
  }
  solver_->set_order(options_.order);
  log().info("{} iterations towards a steady flow left {:.3e} of the first residual", options_.steady_iterations,
             first > 0.0 ? solver_->residual() / first : 0.0);
  write_amounts();
}

void Euler::iterate(const TimeStep& step, const NodeArray& nodes, StepSums& sums)
{
  place(nodes);
  const auto done = (step.index - 1) * options_.iterations_per_step;
  double& first = first_residual_.now()(0, 0);
  for (int i = 0; i < options_.iterations_per_step; ++i) {
    solver_->set_order(done + i < options_.first_order_iterations ? 1 : options_.order);
    require(solver_->iterate(amounts_, step.end, options_.cfl, nodes), nodes, 0.0);
    if (!(first > 0.0)) first = solver_->residual();
  }
  solver_->set_order(options_.order);
  residual_.now()(0, 0) = first > 0.0 ? solver_->residual() / first : 0.0;
  sums.courant = options_.cfl;
  sums.mean_pressure.clear(); // a step of pseudo-time has no mean
}

void Euler::place(const NodeArray& nodes)
{
  if (placed_.cols() == nodes.cols() && placed_ == nodes) return;
  require(solver_->place(nodes), nodes, 0.0);
  placed_ = nodes;
}

void Euler::add_substep(StepSums& sums, double part) const
{
  const auto& integrals = solver_->wall_integrals();
  const double p_ref = options_.reference_pressure;
  for (std::size_t f = 0; f < wall_faces_.size(); ++f) {
    const auto& wall = integrals[static_cast<std::size_t>(wall_faces_[f])];
    sums.mean_pressure[f] += part * wall.mean_pressure;
    sums.impulse += wall.impulse - p_ref * wall.area_time;
    sums.work += wall.work - p_ref * wall.swept;
  }
}

std::string Euler::place_of(Index cell, const NodeArray& nodes) const
{
  const auto& mesh = solver_->mesh();
  const auto c = static_cast<std::size_t>(cell);
  Vec<2> sum = Vec<2>::Zero(); // of the faces' middles: also where the cell has no area
  for (auto k = mesh.cell_face_begin[c]; k < mesh.cell_face_begin[c + 1]; ++k) {
    const auto f = static_cast<std::size_t>(mesh.cell_faces[static_cast<std::size_t>(k)] / 2);
    sum += middle_of<2>(mesh.face_nodes[f], nodes);
  }
  sum /= mesh.cell_face_begin[c + 1] - mesh.cell_face_begin[c];
  return fmt::format("cell {} of {} at ({:.6g}, {:.6g}) m", mesh.order[c], mesh.n_cells, sum.x(), sum.y());
}

void Euler::require(const Outcome<2>& outcome, const NodeArray& nodes, double dt) const
{
  using OutcomeKind = Outcome<2>::Kind;
  if (outcome.kind == OutcomeKind::fine) {
    if (outcome.courant > options_.cfl_warn && dt > 0.0 && !has_warned_) {
      has_warned_ = true;
      log().warning("Courant number {:.3g} in {}; beyond {:.3g} the run ends", outcome.courant,
                    place_of(outcome.courant_cell, nodes), options_.cfl_max);
    }
    return;
  }
  const auto where = place_of(outcome.cell, nodes);
  if (outcome.kind == OutcomeKind::courant)
    throw Error(Errc::numeric,
                fmt::format("{} has a Courant number of {:.4g}, the limit is {:.4g}; take a step below "
                            "{:.4g} s, or more substeps",
                            where, outcome.courant, options_.cfl_max, dt * options_.cfl_max / outcome.courant));
  if (outcome.kind == OutcomeKind::cell_shape)
    throw Error(Errc::numeric, fmt::format("{} is turned over: area {:.4g} m^2; smaller steps, or another mesh motion",
                                           where, outcome.value));
  throw Error(Errc::numeric,
              fmt::format("{} has a density of {:.4g} kg/m^3 and a pressure of {:.4g} Pa, both must be positive; a "
                          "smaller step, a limiter, or a first state closer to the flow may help",
                          where, outcome.state[0], outcome.state[3]));
}

double Euler::max_dt()
{
  const NodeArray nodes = coordinates_.committed();
  place(nodes);
  read_amounts(true);
  return options_.cfl_max * solver_->unit_step(amounts_);
}

double Euler::write_mesh(double file)
{
  return with_code(Errc::io, [&] { return mesh_files::write_mesh_to(options_.mesh, 2, file); });
}

double Euler::list_boundaries(double file)
{
  return with_code(Errc::io, [&] { return mesh_files::list_boundaries_to(options_.mesh, 2, file); });
}

} // namespace mullion::euler
