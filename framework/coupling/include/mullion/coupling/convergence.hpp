// When an iteration within a step has converged, and when it has diverged: per field, by the change d = |new - old|
// against the size N = |new| (Euclidean norms over all entries),
//
//     converged  if d and N are finite and d <= absolute + relative N
//     diverged   if d or N is not finite, or d > 1e6 times the step's first d (or what would have passed then, if that
//                is more)
//
// so infinity never passes for convergence, and a field at rest (0 against 0) passes by its absolute part.
#pragma once

#include <mullion/sdk/window.hpp>

#include <Eigen/Core>

#include <string>
#include <vector>

namespace mullion {

struct Tolerance {
  std::string field; ///< for messages: "velocity"
  double relative = 1e-6;
  double absolute = 0.0; ///< in the field's unit, of the norm
};

class Convergence {
public:
  using Values = Eigen::Ref<const Eigen::MatrixXd>; ///< a field's array, or an iterate's part of any alignment

  Convergence() = default;
  explicit Convergence(std::vector<Tolerance> tolerances)
      : fields_(tolerances.size()), tolerances_(std::move(tolerances))
  {
  }

  void begin_step(const TimeStep& step);
  /// Compare one field's new values with its old ones.
  /// @param field      number of the tolerance
  /// @param iteration  from 0
  /// @throws Error Errc::numeric: the iteration has diverged; names the field and the entry that moved most
  void compare(std::size_t field, int iteration, const Values& now, const Values& before);
  /// Did every field pass in its last comparison?
  [[nodiscard]] bool is_reached() const;
  /// What is still moving: "velocity changed by 1.2e-3 m/s …", for a message.
  [[nodiscard]] std::string describe() const;

private:
  struct Last {
    double first_change = 0.0, change = 0.0, size = 0.0;
    bool has_first = false, has_passed = false;
  };
  std::vector<Last> fields_;
  std::vector<Tolerance> tolerances_;
  TimeStep step_; ///< for messages
};

} // namespace mullion
