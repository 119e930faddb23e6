// Functions of place and time that a user writes in a case file, as muParser reads them: + - * / ^, comparisons,
// c ? a : b, sin, cos, tan, sinh, tanh, exp, ln, log2, log10, sqrt, abs, sign, min, max …, and the constants pi, _pi
// and _e. The variables are x, y, z [m] and t [s]; a coordinate that the space does not have is 0.
#pragma once

#include <Eigen/Core>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace mullion::expressions {

/// The text, what is wrong in it, what would be right.
class ExpressionError : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

/// One number.
class Expression {
public:
  /// @throws ExpressionError
  explicit Expression(const std::string& text);
  ~Expression();
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;

  /// @param x  1 to 3 coordinates
  /// @throws ExpressionError where the value is not finite, with the place
  double operator()(const Eigen::VectorXd& x, double t) const;

private:
  struct Parser; // muParser's, which keeps addresses of its variables
  std::unique_ptr<Parser> parser_;
};

/// How the expressions of a vector are meant.
enum class Along {
  components, ///< one for each dimension of space
  normal      ///< one, times the unit normal
};

/// A vector field on a surface, "f; g; h".
class VectorExpression {
public:
  /// @param text       expressions with ';' between them; "" is the zero vector
  /// @param dimension  of space
  /// @throws ExpressionError also where the number of expressions does not fit
  VectorExpression(const std::string& text, Along along, Eigen::Index dimension);

  /// @param normal  unit normal at x; used with Along::normal only
  Eigen::VectorXd operator()(const Eigen::VectorXd& x, const Eigen::VectorXd& normal, double t) const;

private:
  std::vector<Expression> parts_;
  Along along_;
  Eigen::Index dimension_;
};

} // namespace mullion::expressions
