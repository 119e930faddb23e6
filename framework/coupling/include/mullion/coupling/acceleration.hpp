// How an interface iteration x -> H(x) is steered towards its fixed point: constant relaxation, Aitken's factor, and
// the quasi-Newton methods IQN-ILS (Degroote, Bathe, Vierendeels 2009) and IQN-MVJ (Lindner, Mehl, Scheufele,
// Uekermann 2015). With the residual r_k = H(x_k) - x_k and x~_k = H(x_k):
//
//     constant  x_{k+1} = x_k + theta r_k
//     Aitken    theta_k = -theta_{k-1} <r_{k-1}, r_k - r_{k-1}> / |r_k - r_{k-1}|^2
//     IQN-ILS   x_{k+1} = x~_k + W c,  c = argmin |V c + r_k|;  V, W: differences of residuals and of x~, of this step
//               and of the last steps
//     IQN-MVJ   x_{k+1} = x~_k - J r_k,  J = J_prev + (W - J_prev V)(V^T V)^-1 V^T with this step's columns
//
// What survives a step (columns, J) lies in driver/state, so a step done again gives the same bits; what only lives
// within a step is scratch.
#pragma once

#include <mullion/coupling/module_proxy.hpp>
#include <mullion/coupling/wiring.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace mullion {

struct AccelerationOptions {
  std::string method = "iqn_ils"; ///< constant, aitken, iqn_ils, iqn_mvj
  double relaxation = 0.5;        ///< theta: constant, and Aitken's first in each step
  double first_relaxation = 0.1;  ///< quasi-Newton: for an iteration without any column
  int reuse = 10;                 ///< IQN-ILS: steps whose columns are kept
  int max_columns = 100;
  double filter = 1e-2; ///< a column is dropped if less than this part of it is new
};

class Acceleration {
public:
  /// Above this many unknowns IQN-MVJ keeps columns of 8 steps instead of a dense J: it is IQN-ILS then.
  static constexpr int largest_jacobian = 2000;

  Acceleration() = default;
  explicit Acceleration(AccelerationOptions options) : options_(std::move(options)) {}

  /// Declare what lies in driver/state. @param ports  the fields that x consists of, one after the other
  void define(Wiring& wiring, const std::vector<std::string>& ports);
  void attach(const Coupling& coupling);

  void begin_step(const TimeStep& step);
  /// The next x.
  /// @param x       (n) where H was evaluated
  /// @param result  (n) H(x)
  [[nodiscard]] Eigen::VectorXd next(const Eigen::VectorXd& x, const Eigen::VectorXd& result);
  /// The step has converged: keep what the next steps use.
  /// @param x, result  of the last evaluation
  void end_step(const TimeStep& step, const Eigen::VectorXd& x, const Eigen::VectorXd& result);

private:
  /// body(number, where its entries begin in x, how many)
  template <class Body> void for_each_field(Body&& body) const;
  [[nodiscard]] bool is_quasi_newton() const { return options_.method == "iqn_ils" || options_.method == "iqn_mvj"; }
  [[nodiscard]] Eigen::VectorXd row_scaling() const;
  void weigh_fields(const Eigen::VectorXd& residual);
  void load_columns();
  void store_columns();
  void add_columns(const Eigen::VectorXd& residual, const Eigen::VectorXd& result);
  /// c = argmin |V c + r| over the columns that bring something new. Those left out stay for the next time: other
  /// weights, other neighbours.
  struct Combination {
    std::vector<std::size_t> kept; ///< numbers of the columns
    Eigen::VectorXd c;
  };
  [[nodiscard]] Combination fit_columns(const Eigen::VectorXd& residual) const;
  [[nodiscard]] Eigen::VectorXd least_squares_step(const Eigen::VectorXd& residual,
                                                   const Eigen::VectorXd& result) const;
  [[nodiscard]] Eigen::VectorXd jacobian_step(const Eigen::VectorXd& residual, const Eigen::VectorXd& result) const;

  AccelerationOptions options_;
  std::vector<std::string> ports_;
  std::vector<DriverField> v_state_, w_state_; ///< per port: (entries x max_columns)
  DriverField ages_, jacobian_, last_dt_;
  std::vector<Eigen::Index> sizes_; ///< entries of each port
  Eigen::Index n_ = 0;
  bool has_jacobian_ = false;

  struct Column {
    Eigen::VectorXd v, w;
    int age; ///< steps ago; 0: this step
  };
  // Within a step.
  std::vector<Column> columns_; ///< newest first
  Eigen::VectorXd residual_before_, result_before_;
  std::vector<double> field_sums_; ///< residual-sum weights of the fields
  double theta_ = 0.0;
  int iteration_ = 0;
  bool is_fresh_ = true; ///< nothing is known of the map yet
};

} // namespace mullion
