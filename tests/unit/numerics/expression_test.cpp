// Expressions of a case file.
#include "expressions/expression.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <utility>

using namespace mullion::expressions;

namespace {

std::string complaint(const std::string& text, Along along = Along::components, Eigen::Index dimension = 1)
{
  try {
    const VectorExpression f(text, along, dimension);
    f(Eigen::VectorXd::Zero(dimension), Eigen::VectorXd::Zero(dimension), 0.0);
  } catch (const ExpressionError& error) {
    return error.what();
  }
  return "";
}

} // namespace

TEST_CASE("an expression knows place, time and pi, and 0 for a coordinate that there is not")
{
  const Expression f("2*x + y^2 - z + 10*t + sin(pi/6)");

  CHECK(f(Eigen::Vector3d(1.0, 3.0, 0.5), 2.0) == doctest::Approx(31.0).epsilon(1e-15));
  CHECK(f(Eigen::Vector2d(1.0, 3.0), 0.0) == doctest::Approx(11.5).epsilon(1e-15));
  CHECK(f(Eigen::VectorXd::Ones(1), 0.0) == doctest::Approx(2.5).epsilon(1e-15));
  CHECK(Expression("x > 0 ? 1 : -1")(Eigen::Vector2d(-1.0, 0.0), 0.0) == -1.0);
}

TEST_CASE("an expression that was moved still has its variables")
{
  Expression f("x");
  const Expression moved = std::move(f);

  CHECK(moved(Eigen::VectorXd::Constant(1, 7.0), 0.0) == 7.0);
}

TEST_CASE("a vector has one part a dimension, or one along the normal")
{
  const Eigen::Vector2d x(2.0, 3.0), normal(0.6, 0.8);

  CHECK(VectorExpression("x; x*y", Along::components, 2)(x, normal, 0.0) == Eigen::Vector2d(2.0, 6.0));
  CHECK(VectorExpression("10", Along::normal, 2)(x, normal, 0.0) == Eigen::Vector2d(6.0, 8.0));
  CHECK(VectorExpression("", Along::components, 2)(x, normal, 0.0) == Eigen::Vector2d(0.0, 0.0));
  CHECK(complaint("x", Along::components, 2) ==
        "expression \"x\": 1 parts; 2, one for each dimension, with ; between them");
  CHECK(complaint("x; y", Along::normal, 2) == "expression \"x; y\": 2 parts; 1, the part along the normal");
}

TEST_CASE("errors in an expression show it, and what is wrong in it")
{
  CHECK(complaint("2*(x") == "expression \"2*(x\": Missing parenthesis; numbers, functions, and the "
                             "variables x, y, z and t");
  CHECK(complaint("x + velocity").find("Unexpected token \"velocity\"") != std::string::npos);
  CHECK(complaint("x = 3") == "expression \"x = 3\": an assignment; compare with ==");
  CHECK(complaint("x += 3").find("an assignment") != std::string::npos);
  CHECK(complaint("x == 3 && x <= 4 && x >= 2 && x != 1") == "");
  CHECK(complaint("1, 2") == "expression \"1, 2\": several values; one");
  CHECK(complaint("1/x") == "expression \"1/x\": the value at (0, 0, 0) m, t = 0 s is inf; it must be finite");
}
