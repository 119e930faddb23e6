#include "expression.hpp"

#include <muParser.h>

#include <cmath>
#include <numbers>
#include <sstream>

namespace mullion::expressions {
namespace {

template <class... Pieces> std::string join(const Pieces&... pieces)
{
  std::ostringstream out;
  (out << ... << pieces);
  return out.str();
}

/// muParser knows assignments, with which one evaluation would change the next.
bool has_assignment(const std::string& text)
{
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    if (i + 1 < text.size() && text[i + 1] == '=') ++i; // ==
    else if (i == 0 || std::string("<>!").find(text[i - 1]) == std::string::npos) return true;
  }
  return false;
}

} // namespace

struct Expression::Parser {
  std::string text;
  mu::Parser parser;
  double x = 0.0, y = 0.0, z = 0.0, t = 0.0;
};

Expression::Expression(const std::string& text) : parser_(std::make_unique<Parser>())
{
  auto& p = *parser_;
  p.text = text;
  if (has_assignment(text)) throw ExpressionError(join("expression \"", text, "\": an assignment; compare with =="));
  try {
    p.parser.DefineVar("x", &p.x);
    p.parser.DefineVar("y", &p.y);
    p.parser.DefineVar("z", &p.z);
    p.parser.DefineVar("t", &p.t);
    p.parser.DefineConst("pi", std::numbers::pi);
    p.parser.EnableOptimizer(false); // folding of constants may round in another order than the text says
    p.parser.SetExpr(text);
    p.parser.Eval();
  } catch (const mu::Parser::exception_type& error) {
    throw ExpressionError(
        join("expression \"", text, "\": ", error.GetMsg(), "; numbers, functions, and the variables x, y, z and t"));
  }
  if (p.parser.GetNumResults() != 1) throw ExpressionError(join("expression \"", text, "\": several values; one"));
}

Expression::~Expression() = default;
Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;

double Expression::operator()(const Eigen::VectorXd& x, double t) const
{
  auto& p = *parser_;
  p.x = x[0];
  p.y = x.size() > 1 ? x[1] : 0.0;
  p.z = x.size() > 2 ? x[2] : 0.0;
  p.t = t;
  const double value = p.parser.Eval();
  if (!std::isfinite(value))
    throw ExpressionError(join("expression \"", p.text, "\": the value at (", p.x, ", ", p.y, ", ", p.z, ") m, t = ", t,
                               " s is ", value, "; it must be finite"));
  return value;
}

VectorExpression::VectorExpression(const std::string& text, Along along, Eigen::Index dimension)
    : along_(along), dimension_(dimension)
{
  if (text.find_first_not_of(' ') == std::string::npos) return;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, ';');) parts_.emplace_back(part);
  const auto expected = along == Along::normal ? 1 : dimension;
  if (static_cast<Eigen::Index>(parts_.size()) != expected)
    throw ExpressionError(
        join("expression \"", text, "\": ", parts_.size(), " parts; ", expected,
             along == Along::normal ? ", the part along the normal" : ", one for each dimension, with ; between them"));
}

Eigen::VectorXd VectorExpression::operator()(const Eigen::VectorXd& x, const Eigen::VectorXd& normal, double t) const
{
  if (parts_.empty()) return Eigen::VectorXd::Zero(dimension_);
  if (along_ == Along::normal) return parts_[0](x, t) * normal;
  Eigen::VectorXd value(dimension_);
  for (Eigen::Index k = 0; k < dimension_; ++k) value[k] = parts_[static_cast<std::size_t>(k)](x, t);
  return value;
}

} // namespace mullion::expressions
