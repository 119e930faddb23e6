// A driver that steers a linear map of its own to its fixed point, x -> A x + b, whose solution it knows: what
// Acceleration promises can be counted there. The modules only lend their fields' shapes; they step along unheeded.
//
//   map = multiple  A = -I: all residuals are parallel
//   map = spread    A of full rank whose eigenvalues lie between -3 and -1: the plain iteration diverges
//
// x consists of the structure's velocity and, if two_fields, the fluid's traction, larger by `scale`. b grows with the
// step, x_0 = 0 in each, so a step's first residual is that of the step before, times (n + 1) / n.
#include <mullion/coupling/acceleration.hpp>
#include <mullion/coupling/driver.hpp>

#include <Eigen/LU>

namespace mullion::test {

class FixedPoint final : public Driver {
public:
  struct Options : AccelerationOptions {
    std::string map = "spread";
    bool two_fields = false;
    double scale = 1.0, tolerance = 1e-9;
    int max_iterations = 100;
    Options() { filter = 1e-10; } // columns of this map are never nearly parallel: none may go
    static constexpr auto table()
    {
      return std::tuple{parameter("method", &Options::method, "", "of the acceleration"),
                        parameter("relaxation", &Options::relaxation, "1", "theta"),
                        parameter("first_relaxation", &Options::first_relaxation, "1", "quasi-Newton: first theta"),
                        parameter("reuse", &Options::reuse, "1", "IQN-ILS: steps whose columns are kept"),
                        parameter("map", &Options::map, "", "the map", one_of("multiple", "spread")),
                        parameter("two_fields", &Options::two_fields, "", "the traction belongs to x too"),
                        parameter("scale", &Options::scale, "1", "of the traction's part of x"),
                        parameter("tolerance", &Options::tolerance, "1", "largest residual, against the first"),
                        parameter("max_iterations", &Options::max_iterations, "1", "evaluations in a step")};
    }
  };
  explicit FixedPoint(const Options& options) : options_(options), acceleration_(options) {}

  void define(Wiring& wiring) override
  {
    const auto& [wall, wet] = wiring.interfaces()[0];
    fluid_name_ = wiring.instance("fluid");
    structure_name_ = wiring.instance("structure");
    wiring.bind(wall + ".velocity", wet + ".velocity");
    wiring.bind(wet + ".traction", wall + ".traction");
    ports_ = {wet + ".velocity"};
    if (options_.two_fields) ports_.push_back(wall + ".traction");
    acceleration_.define(wiring, ports_);
    wiring.report_number("iterations");
  }

  void attach(Coupling& coupling) override
  {
    fluid_ = coupling.module(fluid_name_);
    structure_ = coupling.module(structure_name_);
    acceleration_.attach(coupling);
    iterations_ = coupling.state("iterations");
    const auto n_first = coupling.field(ports_.front()).committed().size();
    const auto n = options_.two_fields ? n_first + coupling.field(ports_.back()).committed().size() : n_first;
    make_map(n, n_first);
  }

  void start(const TimeStep& initial) override
  {
    structure_.start(initial);
    fluid_.start(initial);
  }

  void step(const TimeStep& step) override
  {
    structure_.step(step);
    fluid_.step(step);

    const Vector b = static_cast<double>(step.index) * b_;
    const auto map = [&](const Vector& x) -> Vector { return scale_.cwiseProduct(a_ * x.cwiseQuotient(scale_) + b); };
    acceleration_.begin_step(step);
    Vector x = Vector::Zero(b.size()), result;
    double first = 0.0;
    int k = 0;
    for (;; ++k) {
      result = map(x);
      const double residual = (result - x).cwiseQuotient(scale_).norm();
      if (k == 0) first = residual;
      if (residual <= options_.tolerance * first) break;
      MULLION_REQUIRE(k + 1 < options_.max_iterations, Errc::numeric, "residual {:.3e} of {:.3e} after {} iterations",
                      residual, first, options_.max_iterations);
      x = acceleration_.next(x, result);
    }
    acceleration_.end_step(step, x, result);
    iterations_.now()(0, 0) = k + 1;

    // |I - A|^-1 is at most 1/2 for either map, in rows and columns of nearly equal size: ten times the residual.
    const Vector exact = scale_.cwiseProduct((Matrix::Identity(b.size(), b.size()) - a_).lu().solve(b));
    const double error = (x - exact).cwiseQuotient(scale_).norm();
    MULLION_REQUIRE(error <= 10.0 * options_.tolerance * first, Errc::numeric, "step {}: x is off by {:.3e}",
                    step.index, error);
  }

private:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  void make_map(Eigen::Index n, Eigen::Index n_first)
  {
    a_ = -Matrix::Identity(n, n);
    b_.resize(n);
    scale_.setOnes(n);
    for (Eigen::Index i = 0; i < n; ++i) b_(i) = 1.0 + 0.1 * static_cast<double>(i);
    scale_.tail(n - n_first).setConstant(options_.scale);
    if (options_.map == "multiple") return;
    for (Eigen::Index i = 0; i < n; ++i) a_(i, i) -= 2.0 * static_cast<double>(i) / static_cast<double>(n);
    for (Eigen::Index i = 0; i + 1 < n; ++i) a_(i, i + 1) = 0.2, a_(i + 1, i) = -0.1;
  }

  Options options_;
  Acceleration acceleration_;
  std::string fluid_name_, structure_name_;
  std::vector<std::string> ports_;
  ModuleProxy fluid_, structure_;
  DriverField iterations_;
  Matrix a_;
  Vector b_, scale_;
};

} // namespace mullion::test

MULLION_DRIVER(mullion::test::FixedPoint, "fixed_point", "test driver: a linear map of its own, accelerated");
