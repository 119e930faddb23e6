// Strong (implicit) coupling: fluid and structure are iterated within each step until motion and traction agree.
//
//   iteration = serial    x = motion at t^{n+1};            H(x) = S(F(x)): fluid, then structure
//   iteration = parallel  x = (motion, traction) at t^{n+1}; H(x) = (S(traction), F(motion)): both at the same time
//
// x_0 is extrapolated; the acceleration (constant relaxation, Aitken, IQN-ILS, IQN-MVJ) steers x_k to the fixed point.
// Every evaluation starts both solvers from t^n again. No net lag, second order in time, any mass ratio.
#include <mullion/coupling/acceleration.hpp>
#include <mullion/coupling/convergence.hpp>
#include <mullion/coupling/predictor.hpp>
#include <mullion/coupling/roles.hpp>

namespace mullion::strong {

class Strong final : public Driver {
public:
  struct Options : FsiOptions {
    std::string iteration = "serial", acceleration = "iqn_ils", predictor = "linear";
    double relaxation = 0.5, first_relaxation = 0.1, filter = 0.0;
    int reuse = 10, max_columns = 100, max_iterations = 100;
    double motion_tolerance = 1e-6, traction_tolerance = 1e-6;
    double motion_floor = 1e-12, traction_floor = 1e-9;
    std::string on_not_converged = "fail";

    Options() { profile = "linear"; }
    static constexpr auto table()
    {
      return std::tuple_cat(
          std::tuple{
              parameter("iteration", &Options::iteration, "", "one solver after the other, or both at the same time",
                        one_of("serial", "parallel")),
              parameter("acceleration", &Options::acceleration, "", "how the iteration is steered",
                        one_of("constant", "aitken", "iqn_ils", "iqn_mvj")),
              parameter("predictor", &Options::predictor, "", "first guess, extrapolated from the last steps",
                        one_of("constant", "linear", "quadratic")),
              parameter("relaxation", &Options::relaxation, "1",
                        "constant: theta; aitken: theta of the first iteration", above(0.0))
                  .changeable(),
              parameter("first_relaxation", &Options::first_relaxation, "1",
                        "quasi-Newton: theta while nothing is known", above(0.0))
                  .changeable(),
              parameter("reuse", &Options::reuse, "1", "iqn_ils: steps whose columns are kept", between(0.0, 1000.0)),
              parameter("max_columns", &Options::max_columns, "1", "quasi-Newton: columns at most",
                        between(1.0, 10000.0)),
              parameter("filter", &Options::filter, "1",
                        "quasi-Newton: least new part of a column; 0: 1e-2 serial, 1e-3 parallel", between(0.0, 1.0))
                  .changeable(),
              parameter("motion_tolerance", &Options::motion_tolerance, "1", "change of the motion, relative",
                        at_least(0.0))
                  .changeable(),
              parameter("motion_floor", &Options::motion_floor, "m/s",
                        "change of the motion (norm over all values) that always passes; m for motion = displacement",
                        at_least(0.0))
                  .changeable(),
              parameter("traction_tolerance", &Options::traction_tolerance, "1", "change of the traction, relative",
                        at_least(0.0))
                  .changeable(),
              parameter("traction_floor", &Options::traction_floor, "Pa",
                        "change of the traction (norm over all values) that always passes", at_least(0.0))
                  .changeable(),
              parameter("max_iterations", &Options::max_iterations, "1", "evaluations of both solvers in a step",
                        at_least(1))
                  .changeable(),
              parameter("on_not_converged", &Options::on_not_converged, "", "what a step without convergence is",
                        one_of("fail", "accept_with_warning"))
                  .changeable()},
          profile_option(), sampling_option(), load_interpolation_option(), motion_option(), exchange_options());
    }
  };

  explicit Strong(const Options& options)
      : options_(options), is_parallel_(options.iteration == "parallel"),
        convergence_({{options.motion, options.motion_tolerance, options.motion_floor},
                      {"traction", options.traction_tolerance, options.traction_floor}}),
        acceleration_({options.acceleration, options.relaxation, options.first_relaxation, options.reuse,
                       options.max_columns, options.filter > 0.0 ? options.filter : (is_parallel_ ? 1e-3 : 1e-2)})
  {
  }

  void define(Wiring& wiring) override
  {
    names_ = wire_fsi(wiring, options_);
    const auto motion = names_.wet + "." + names_.motion, load = names_.load;
    wiring.history(names_.wet, 3); // the predictor's
    if (is_parallel_) wiring.history(names_.transfer + ".structure_side", 3);
    acceleration_.define(wiring, is_parallel_ ? std::vector{motion, load} : std::vector{motion});
    wiring.report_number("iterations");
    wiring.state_numbers("previous_dt", 1);
    wiring.state_net_lag((options_.is_profile_linear() ? 0.0 : -0.5) + options_.sampling_lag());
  }

  void attach(Coupling& coupling) override
  {
    coupling_ = coupling;
    roles_ = FsiRoles(coupling, names_);
    acceleration_.attach(coupling);
    iterations_ = coupling.state("iterations");
    previous_dt_ = coupling.state("previous_dt");
  }

  void start(const TimeStep& initial) override
  {
    roles_.start(initial);
    previous_dt_.now()(0, 0) = initial.dt;
  }

  void step(const TimeStep& step) override
  {
    convergence_.begin_step(step);
    acceleration_.begin_step(step);
    load_before_ = roles_.load_on_structure.committed();
    Vector x = predicted(step), result;
    int k = 0;
    for (;; ++k) {
      TimeStep iteration = step;
      iteration.iteration = k;
      result = evaluate(x, iteration); // H(x_k)
      if (has_converged(x, k)) break;
      if (k + 1 == options_.max_iterations) {
        give_up(step);
        break;
      }
      x = acceleration_.next(x, result);
    }
    acceleration_.end_step(step, x, result);
    iterations_.now()(0, 0) = k + 1;
    previous_dt_.now()(0, 0) = step.dt;
  }

private:
  using Vector = Eigen::VectorXd;

  /// H(x): both solvers from t^n, one after the other or at the same time.
  Vector evaluate(const Vector& x, const TimeStep& step)
  {
    roles_.send_motion(motion_of(x), step);
    if (roles_.has_mesh_motion) roles_.mesh_motion.step(step);
    if (is_parallel_) {
      roles_.structure_load.put(load_of(x), step.end);
      roles_.fluid.begin_step(step);
      roles_.structure.begin_step(step);
      roles_.fluid.await();
      roles_.structure.await();
      roles_.transfer_loads(step);
    } else {
      roles_.fluid.step(step);
      roles_.transfer_loads(step);
      roles_.load_structure(roles_.load_on_structure.now(), step);
    }
    return joined(roles_.structure_motion.now(), roles_.load_on_structure.now());
  }

  Vector predicted(const TimeStep& step) const
  {
    const auto& [v, p] = std::tie(roles_.structure_motion, roles_.load_on_structure);
    const auto at = [&](int back) {
      return is_parallel_ ? joined(v.committed(back), p.committed(back)) : joined(v.committed(back), p.committed());
    };
    const double ratio = step.dt / previous_dt_.committed()(0, 0);
    const bool is_constant = options_.predictor == "constant" || step.index < 2;
    const bool is_quadratic = options_.predictor == "quadratic" && step.index > 2 && ratio == 1.0;
    if (is_constant) return at(1);
    if (is_quadratic) return extrapolated_quadratically(at(1), at(2), at(3));
    return extrapolated_linearly(at(1), at(2), ratio);
  }

  bool has_converged(const Vector& x, int k)
  {
    convergence_.compare(0, k, roles_.structure_motion.now(), motion_of(x));
    // Serial: the traction of this evaluation against that of the one before. Parallel: against the one that the
    // structure got; two evaluations in a row may agree on a traction that it never felt.
    if (is_parallel_) load_before_ = load_of(x);
    convergence_.compare(1, k, roles_.load_on_structure.now(), load_before_);
    load_before_ = roles_.load_on_structure.now();
    return convergence_.is_reached();
  }

  void give_up(const TimeStep& step)
  {
    const auto text = fmt::format("step {} (t = {} s) has not converged after {} iterations: {}", step.index,
                                  step.begin, options_.max_iterations, convergence_.describe());
    MULLION_REQUIRE(options_.on_not_converged != "fail", Errc::numeric,
                    "{}; allow more (max_iterations), or accept it (on_not_converged = \"accept_with_warning\")", text);
    if (!has_warned_) coupling_.warn(text + "; accepted, and so will be others, without a word");
    has_warned_ = true; // once is enough; no state: it changes nothing but the log
  }

  // x is the motion on the structure's nodes, followed by the traction on them if both solvers run at the same time.
  [[nodiscard]] Vector joined(const ConstArray& motion, const ConstArray& load) const
  {
    Vector x(is_parallel_ ? motion.size() + load.size() : motion.size());
    x.head(motion.size()) = Eigen::Map<const Vector>(motion.data(), motion.size());
    if (is_parallel_) x.tail(load.size()) = Eigen::Map<const Vector>(load.data(), load.size());
    return x;
  }
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> motion_of(const Vector& x) const
  {
    const auto like = roles_.structure_motion.committed();
    return {x.data(), like.rows(), like.cols()};
  }
  [[nodiscard]] Eigen::Map<const Eigen::MatrixXd> load_of(const Vector& x) const
  {
    const auto like = roles_.load_on_structure.committed();
    return {x.data() + x.size() - like.size(), like.rows(), like.cols()};
  }

  Options options_;
  bool is_parallel_;
  FsiNames names_;
  FsiRoles roles_;
  Coupling coupling_;
  Convergence convergence_;
  Acceleration acceleration_;
  Eigen::MatrixXd load_before_; ///< within a step: the traction of the evaluation before
  DriverField iterations_;      ///< evaluations of H in the last step
  DriverField previous_dt_;     ///< dt_{n-1} [s]
  bool has_warned_ = false;
};

} // namespace mullion::strong

MULLION_DRIVER(mullion::strong::Strong, "strong", "implicit coupling: constant, Aitken, IQN-ILS, IQN-MVJ");
