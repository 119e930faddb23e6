// Coupling with combined interface boundary conditions (CIBC): the scheme corrects the velocity that the fluid gets and
// the traction that the structure gets by a combination of the interface's rates. Algorithm 3 of Jaiman et al. 2011;
// the formulas are in corrections.hpp.
//
//   reading = consistent      velocity from v_s^n, traction with the fluid's own rate; neutral where CSS grows
//   reading = printed         the text taken literally (it adds the velocity increment twice)
//   half_offset = true        leap-frog, the fluid half a step behind: the traction correction alone
//   sub_iterations = K        the structure is redone with the corrected traction K times
//
// In two and three dimensions each face of the fluid's wall has its own correction, along its normal. The weight omega
// must lie within a window; it is checked at the start and in each step, on all faces.
#include "corrections.hpp"
#include "wall_faces.hpp"

#include <mullion/coupling/half_step.hpp>
#include <mullion/coupling/roles.hpp>

#include <algorithm>
#include <limits>

namespace mullion::cibc {

class Cibc final : public Driver {
public:
  struct Options : FsiOptions {
    double fluid_density = 0.0;
    double omega = 0.0, kappa = 0.0, h = 0.0;
    double sound_speed = 0.0, reference_velocity = 0.0;
    std::string reading = "consistent";
    bool half_offset = false, starts_early = false, w_end = true;
    bool subtract_gradient = false, clamped_rim = true;
    std::string acceleration = "structure";
    int sub_iterations = 0;
    std::string omega_check = "error";

    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{
              required_parameter("fluid_density", &Options::fluid_density, "kg/m^3", "undisturbed density of the fluid",
                                 above(0.0)),
              parameter("omega", &Options::omega, "s/m", "weight of the pressure rates; or give kappa, or h",
                        at_least(0.0))
                  .changeable(),
              parameter("kappa", &Options::kappa, "1", "weight as omega times sound_speed; 0.4 if none is given",
                        at_least(0.0))
                  .changeable(),
              parameter("h", &Options::h, "1", "weight as omega times reference_velocity", at_least(0.0)).changeable(),
              parameter("sound_speed", &Options::sound_speed, "m/s", "undisturbed sound speed, for kappa",
                        at_least(0.0)),
              parameter("reference_velocity", &Options::reference_velocity, "m/s",
                        "for h: the step in pressure over sqrt(rho_s E_s), in the paper's piston", at_least(0.0)),
              parameter("reading", &Options::reading, "", "of the algorithm: consistent, or as printed",
                        one_of("consistent", "printed")),
              parameter("half_offset", &Options::half_offset, "", "the fluid runs half a step behind the structure"),
              parameter("starts_early", &Options::starts_early, "", HalfStepClock::meaning),
              parameter("w_end", &Options::w_end, "",
                        "half_offset: the exported pressure goes with the wall velocity at its own time"),
              parameter("acceleration", &Options::acceleration, "",
                        "half_offset: the structure's own, or the difference of its last two velocities",
                        one_of("structure", "difference")),
              parameter("subtract_gradient", &Options::subtract_gradient, "",
                        "count dp/dn_f from its value at the start: a steady flow along a curved wall has one"),
              parameter("clamped_rim", &Options::clamped_rim, "",
                        "no velocity correction on the wall's rim, in two and three dimensions"),
              parameter("sub_iterations", &Options::sub_iterations, "1",
                        "how often a step is redone with the corrected traction", between(0.0, 100.0)),
              parameter("omega_check", &Options::omega_check, "", "what an inadmissible weight is",
                        one_of("error", "warn"))
                  .changeable()},
          load_interpolation_option(), receives_option());
    }
  };

  explicit Cibc(const Options& options) : options_(options), omega_(weight(options))
  {
    const bool is_printed = options.reading == "printed";
    MULLION_REQUIRE(!options.half_offset || (!is_printed && options.sub_iterations == 0), Errc::config,
                    "half_offset = true goes with reading = \"consistent\" and sub_iterations = 0 only");
    MULLION_REQUIRE(!is_printed || options.sub_iterations == 0, Errc::config,
                    "sub_iterations goes with reading = \"consistent\" only");
    MULLION_REQUIRE(options.half_offset || !options.starts_early, Errc::config,
                    "starts_early = true has no meaning without half_offset = true");
    MULLION_REQUIRE(options.half_offset || options.acceleration == "structure", Errc::config,
                    "acceleration = \"difference\" goes with half_offset = true only");
    if (options.half_offset) options_.load_interpolation = "constant";
    options_.profile = options.half_offset || is_printed ? "constant" : "linear";
  }

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_,
                      {.corrects_on_fluid = true, .sends_evaluation_velocity = options_.half_offset && options_.w_end});
    wiring.history(names_.wall, 2);                                           // P^{n-1}
    if (options_.acceleration == "difference") wiring.history(names_.wet, 2); // v_s^{n-1}
    wiring.state_like("applied", names_.wall + ".pressure_gradient");
    wiring.state_like("start_gradient", names_.wall + ".pressure_gradient");
    wiring.state_levels(2); // P_s^{n-1}
    clock_.define(wiring, options_.starts_early, {names_.fluid, names_.mesh_motion});
    wiring.explain_divergence("cibc is stable for weights within a window only (kappa = omega c between c dt/dx and "
                              "1/2 + 4/3 c dt/dx, half_offset has no upper bound), and where the fluid's added mass "
                              "outweighs the structure's no scheme without iterations is");
  }

  void attach(Coupling& coupling) override
  {
    coupling_ = coupling;
    roles_ = FsiRoles(coupling, names_);
    acceleration_ = coupling.field(names_.wet + ".acceleration");
    gradient_ = coupling.field(names_.wall + ".pressure_gradient");
    sound_speed_ = coupling.field(names_.wall + ".sound_speed");
    spacing_ = coupling.field(names_.wall + ".wall_spacing");
    applied_ = coupling.state("applied");
    start_gradient_ = coupling.state("start_gradient");
    clock_.attach(coupling);
    const auto pane = coupling.pane(names_.wall);
    std::vector<Faces> blocks;
    for (const auto& block : pane.blocks) blocks.push_back(block.connectivity);
    wall_ = wall_faces(pane.coordinates, std::move(blocks));
    is_one_dimensional_ = pane.coordinates.rows() == 1;
    if (!is_one_dimensional_) normal_ = coupling.field(names_.wall + ".normal");
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    applied_.now() = pressure(0).matrix();
    if (options_.subtract_gradient) start_gradient_.now() = gradient_.now();
    else start_gradient_.now().setZero();
    clock_.start(initial);
    check_weight(initial, sound_speed_.now(), spacing_.now());
  }

  void step(const TimeStep& step) override
  {
    check_weight(step, sound_speed_.committed(), spacing_.committed());
    if (options_.half_offset) half_offset(step);
    else if (options_.sub_iterations > 0) sub_iterated(step);
    else collocated(step);
    clock_.end_step(step);
  }

private:
  // Algorithm 3, collocated. consistent: velocity from v_s^n, dP = dt (P_t - r/omega); printed: velocity from
  // v_s^{n+1}, dP = dt (P_s,t - r/omega).
  void collocated(const TimeStep& step)
  {
    const bool is_printed = options_.reading == "printed";
    const auto& v = roles_.structure_motion;
    const double dt = step.dt, rho = options_.fluid_density;
    const Values applied_rate = rate(values(applied_, 1), values(applied_, 2), clock_.previous_dt(step));
    const Values fluid_rate = rate(pressure(1), pressure(2), clock_.previous_dt(step));

    roles_.load_structure(roles_.load_on_structure.committed(), step); // P_s^n is an estimate for t^{n+1}: (a)
    const Values dv = velocity_increment(dt, rho, omega_, gradient(1), fluid_rate, applied_rate);
    roles_.send_motion(is_printed ? v.now() : v.committed(), step);
    roles_.wall_velocity.put(roles_.motion_on_fluid.now() + along_normals(dv, 1), step.end); // (b)
    roles_.mesh_motion.step(step);
    roles_.fluid.step(step); // (c)
    const Values r = residual(acceleration_.now(), step);
    const Values p_rate = is_printed ? applied_rate : rate(pressure(0), pressure(1), dt);
    apply(pressure(0) + dt * (p_rate - r / omega_), step); // (d): P_s^{n+1}
  }

  // The half-offset form: ISS plus the traction correction.
  void half_offset(const TimeStep& step)
  {
    const auto& [v, a] = std::tie(roles_.structure_motion, acceleration_);
    const auto window = clock_.window(step); // around t^n

    if (options_.w_end) roles_.send_evaluation_velocity(v.committed() + 0.5 * step.dt * a.committed(), window);
    roles_.send_motion(v.committed(), window);
    roles_.wall_velocity.put(roles_.motion_on_fluid.now(), window.end);
    roles_.mesh_motion.step(window);
    roles_.fluid.step(window);
    const Values r = options_.acceleration == "structure"
                         ? residual(a.committed(), window)
                         : residual((v.committed() - v.committed(2)) / clock_.previous_dt(step), window);
    apply(pressure(0) - step.dt / omega_ * r, window); // P_s^{n+1/2}
    roles_.load_structure_mean(roles_.load_on_structure.now(), step);
  }

  // Predictor-corrector: the structure steps again under the corrected traction; the last pass counts.
  void sub_iterated(const TimeStep& step)
  {
    Values next;
    roles_.structure_load.put(roles_.load_on_structure.committed(), step.end); // s_0 = P_s^n
    for (int k = 0; k <= options_.sub_iterations; ++k) {
      TimeStep pass = step;
      pass.iteration = k;
      roles_.structure.step(pass); // s_k
      roles_.send_motion(roles_.structure_motion.now(), pass);
      roles_.wall_velocity.put(roles_.motion_on_fluid.now(), pass.end);
      roles_.mesh_motion.step(pass);
      roles_.fluid.step(pass);
      next = pressure(0) - step.dt / omega_ * residual(acceleration_.now(), pass); // s_{k+1}
      if (k == options_.sub_iterations) break;
      apply(next, pass);
      roles_.structure_load.put(roles_.load_on_structure.now(), step.end);
    }
    apply(next + (pressure(0) - pressure(1)), step); // P_s^{n+1} = s_{K+1} + (P^{n+1} - P^n)
  }

  /// r on the fluid's faces, for the pressure that the fluid exports now.
  template <class Vectors>
  [[nodiscard]] Values residual(const Vectors& structure_acceleration, const TimeStep& step) const
  {
    roles_.send_motion(structure_acceleration, step); // the operator that carries velocities carries their rates
    const auto on_faces = mean_on_faces(wall_, roles_.motion_on_fluid.now());
    return acceleration_residual(options_.fluid_density, gradient(0), normal_part(on_faces, 0));
  }
  /// The traction that goes to the structure's side.
  void apply(const Values& traction, const TimeStep& step) const
  {
    applied_.now() = traction.matrix();
    roles_.wall_traction.put(times_normals(traction, 0), step.end);
    roles_.transfer_loads(step);
  }

  // One value a face, `back` steps ago (0: now).
  template <class F> static Values values(const F& field, int back)
  {
    return back == 0 ? Values(field.now().array()) : Values(field.committed(back).array());
  }
  [[nodiscard]] Values gradient(int back) const { return values(gradient_, back) - values(start_gradient_, 0); }
  /// p - p_ref, what the traction is along n_f.
  [[nodiscard]] Values pressure(int back) const
  {
    const auto& t = roles_.fluid_traction;
    return normal_part(back == 0 ? t.now() : t.committed(back), back);
  }
  template <class Vectors> [[nodiscard]] Values normal_part(const Vectors& on_faces, int back) const
  {
    if (is_one_dimensional_) return on_faces.array(); // n_f = 1
    return on_faces.cwiseProduct(back == 0 ? normal_.now() : normal_.committed(back)).colwise().sum().array();
  }
  [[nodiscard]] Eigen::MatrixXd times_normals(const Values& on_faces, int back) const
  {
    if (is_one_dimensional_) return on_faces.matrix();
    return (back == 0 ? normal_.now() : normal_.committed(back)) * on_faces.matrix().asDiagonal();
  }
  /// Values on faces, as vectors on the wall's nodes along their normals.
  [[nodiscard]] Eigen::MatrixXd along_normals(const Values& on_faces, int back) const
  {
    Eigen::MatrixXd on_nodes = mean_on_nodes(wall_, on_faces.matrix());
    if (is_one_dimensional_) return on_nodes;
    const auto normals = mean_on_nodes(wall_, normal_.committed(back)).colwise().normalized().eval();
    on_nodes = (normals * on_nodes.row(0).asDiagonal()).eval();
    for (Eigen::Index i = 0; options_.clamped_rim && i < on_nodes.cols(); ++i)
      if (wall_.is_at_rim[static_cast<std::size_t>(i)]) on_nodes.col(i).setZero();
    return on_nodes;
  }
  static Values rate(const Values& now, const Values& before, double dt) { return (now - before) / dt; }

  static double weight(const Options& options)
  {
    const int n_given = (options.omega > 0.0) + (options.kappa > 0.0) + (options.h > 0.0);
    MULLION_REQUIRE(n_given <= 1, Errc::config,
                    "omega, kappa and h are three ways to give one weight; give one of them");
    if (options.omega > 0.0) return options.omega;
    if (options.h > 0.0) {
      MULLION_REQUIRE(options.reference_velocity > 0.0, Errc::config,
                      "h = {} needs reference_velocity, in m/s: the weight is h / reference_velocity", options.h);
      return options.h / options.reference_velocity;
    }
    MULLION_REQUIRE(options.sound_speed > 0.0, Errc::config,
                    "the weight kappa needs sound_speed, the undisturbed fluid's, in m/s (or give omega)");
    return (options.kappa > 0.0 ? options.kappa : 0.4) / options.sound_speed;
  }

  [[nodiscard]] Window window(double courant) const
  {
    constexpr double none = std::numeric_limits<double>::infinity();
    if (options_.half_offset) return {0.1 * courant, none, none, courant};
    if (options_.sub_iterations > 0) return {0.0, none, none, courant};
    if (options_.reading == "printed") return {0.0, 8.0 / 3.0 * courant, 0.3, courant};
    return {0.0, 0.5 + 4.0 / 3.0 * courant, 0.3, courant};
  }

  void check_weight(const TimeStep& step, const ConstArray& sound_speed, const ConstArray& spacing)
  {
    constexpr double round_off = 1e-9; // a weight at the very bound is within
    for (Eigen::Index face = 0; face < sound_speed.cols(); ++face) {
      const double c = sound_speed(0, face), courant = c * step.dt / spacing(0, face), kappa = omega_ * c;
      const auto allowed = window(courant);
      const auto bounds = fmt::format("wall point {}, t = {} s: c dt/dx = {:.4g}, kappa = omega c = {:.4g}; admissible "
                                      "are {:.4g} <= kappa <= {:.4g}, that is {:.4g} <= omega <= {:.4g} s/m",
                                      face, step.begin, courant, kappa, allowed.lower, allowed.upper, allowed.lower / c,
                                      allowed.upper / c);
      if (courant > allowed.largest_courant)
        complain(fmt::format("{}, with c dt/dx <= {}; take a smaller step, or half_offset = true, which has no such "
                             "limit",
                             bounds, allowed.largest_courant));
      else if (kappa < (1 - round_off) * allowed.lower || kappa > (1 + round_off) * allowed.upper) complain(bounds);
      else if (kappa < allowed.advisable && !has_warned_)
        warn(fmt::format("{}; below kappa = {:.4g} grid-scale noise may grow", bounds, allowed.advisable));
    }
  }
  void complain(const std::string& text)
  {
    if (options_.omega_check == "error")
      throw Error(Errc::config, fmt::format("cibc: the weight is outside of its window at {} (omega_check = \"warn\" "
                                            "runs it all the same)",
                                            text));
    if (!has_warned_) warn("the weight is outside of its window at " + text);
  }
  void warn(const std::string& text)
  {
    coupling_.warn(text);
    has_warned_ = true; // once is enough; no state: it changes nothing but the log
  }

  Options options_;
  double omega_; ///< [s/m]
  FsiNames names_;
  FsiRoles roles_;
  Coupling coupling_;
  ModuleField acceleration_;                     ///< of the wet surface
  ModuleField gradient_, sound_speed_, spacing_; ///< of the fluid's wall
  ModuleField normal_;                           ///< of its faces, n_f; unused in one dimension
  DriverField applied_;                          ///< P_s on the fluid's side [Pa]
  DriverField start_gradient_;                   ///< dp/dn_f that counts as zero [Pa/m]
  WallFaces wall_;
  bool is_one_dimensional_ = true;
  HalfStepClock clock_;
  bool has_warned_ = false;
};

} // namespace mullion::cibc

MULLION_DRIVER(mullion::cibc::Cibc, "cibc", "combined interface boundary conditions (Algorithm 3)");
