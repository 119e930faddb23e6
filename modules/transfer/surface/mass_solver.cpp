#include "mass_solver.hpp"

#include <cmath>
#include <limits>

namespace mullion::surface {

namespace {

constexpr int most_steps = 200;       // a dozen are usual; faces that are covered in part need more
constexpr double round_off = 0x1p-53; // of the preconditioned residual, against that of the right hand side

/// A number for each component; three are kept as four, which the processor takes in pairs.
template <int n> using Numbers = Eigen::Array<double, n, 1>;
template <int n> using Vectors = Eigen::Array<double, n, Eigen::Dynamic>;

/// The steps of one solution. Each goes over the matrix twice and over the vectors thrice.
template <int n> struct Steps {
  const ScaledMass& mass;
  Vectors<n> residual, direction, upper, image, x;

  /// direction <- residual + turn direction, upper <- (I + U)^-1 direction, image <- direction - upper
  void turn(const Numbers<n>& turn)
  {
    for (Eigen::Index i = direction.cols() - 1; i >= 0; --i) {
      const Numbers<n> d = residual.col(i) + turn * direction.col(i);
      Numbers<n> u = d;
      for (auto k = begin(i); k < begin(i + 1); ++k) u -= mass.values[k] * upper.col(mass.columns[k]);
      direction.col(i) = d;
      upper.col(i) = u;
      image.col(i) = d - u;
    }
  }
  /// image <- (I + U^T)^-1 image + upper. @return direction . image
  Numbers<n> finish_image()
  {
    Numbers<n> product = Numbers<n>::Zero();
    for (Eigen::Index i = 0; i < image.cols(); ++i) {
      const Numbers<n> w = image.col(i);
      for (auto k = begin(i); k < begin(i + 1); ++k) image.col(mass.columns[k]) -= mass.values[k] * w;
      const Numbers<n> all = w + upper.col(i);
      image.col(i) = all;
      product += direction.col(i) * all;
    }
    return product;
  }
  /// x <- x + length upper, residual <- residual - length image. @return residual . residual
  Numbers<n> go(const Numbers<n>& length)
  {
    Numbers<n> product = Numbers<n>::Zero();
    for (Eigen::Index i = 0; i < x.cols(); ++i) {
      x.col(i) += length * upper.col(i);
      const Numbers<n> r = residual.col(i) - length * image.col(i);
      residual.col(i) = r;
      product += r * r;
    }
    return product;
  }
  [[nodiscard]] std::size_t begin(Eigen::Index row) const
  {
    return static_cast<std::size_t>(mass.row_begin[static_cast<std::size_t>(row)]);
  }
};

template <int n>
bool solve_components(const ScaledMass& mass, const Eigen::Ref<const Eigen::MatrixXd>& right, Eigen::MatrixXd& solution)
{
  const Eigen::Index n_components = right.rows(), n_columns = right.cols();
  const Vectors<n> zeros = Vectors<n>::Zero(n, n_columns);
  Steps<n> steps{mass, zeros, zeros, zeros, zeros, zeros};
  for (Eigen::Index i = 0; i < n_columns; ++i) // image <- (I + U^T)^-1 right, with nothing to add
    for (Eigen::Index c = 0; c < n_components; ++c) steps.image(c, i) = mass.scale[i] * right(c, i);
  (void)steps.finish_image();
  steps.residual = steps.image;
  Numbers<n> square = steps.go(Numbers<n>::Zero());
  const Numbers<n> wanted = round_off * round_off * square;

  Numbers<n> turn = Numbers<n>::Zero();
  bool is_solved = (square <= wanted).all(), is_positive = true; // zeros are solved
  for (int step = 0; step < most_steps && !is_solved && is_positive; ++step) {
    steps.turn(turn);
    const Numbers<n> curvature = steps.finish_image();
    Numbers<n> length = Numbers<n>::Zero();
    for (int c = 0; c < n; ++c) {
      if (square[c] <= wanted[c]) continue;            // this component is done, and rests
      is_positive = is_positive && curvature[c] > 0.0; // nor if it is NaN
      length[c] = square[c] / curvature[c];
    }
    const Numbers<n> next = steps.go(length);
    for (int c = 0; c < n; ++c) turn[c] = square[c] <= wanted[c] ? 0.0 : next[c] / square[c];
    square = next;
    is_solved = (square <= wanted).all();
  }
  solution.resize(n_components, n_columns);
  for (Eigen::Index i = 0; i < n_columns; ++i)
    for (Eigen::Index c = 0; c < n_components; ++c)
      solution(c, i) = is_solved ? mass.scale[i] * steps.x(c, i) : std::numeric_limits<double>::quiet_NaN();
  return is_solved;
}

} // namespace

ScaledMass scaled_mass(const Operator& matrix, const std::vector<bool>& is_pinned)
{
  const Eigen::Index n = matrix.rows();
  ScaledMass mass;
  mass.scale = Eigen::VectorXd::Zero(n);
  for (Eigen::Index i = 0; i < n; ++i)
    if (!is_pinned[static_cast<std::size_t>(i)]) mass.scale[i] = 1.0 / std::sqrt(matrix.coeff(i, i));
  mass.row_begin.reserve(static_cast<std::size_t>(n) + 1);
  mass.row_begin.push_back(0);
  mass.columns.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2);
  mass.values.reserve(static_cast<std::size_t>(matrix.nonZeros()) / 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Operator::InnerIterator it(matrix, i); it; ++it) {
      const double value = mass.scale[i] * it.value() * mass.scale[it.col()];
      if (it.col() <= i || value == 0.0) continue;
      mass.columns.push_back(static_cast<std::int32_t>(it.col()));
      mass.values.push_back(value);
    }
    mass.row_begin.push_back(static_cast<std::int64_t>(mass.columns.size()));
  }
  return mass;
}

bool conjugate_gradients(const ScaledMass& mass, const Eigen::Ref<const Eigen::MatrixXd>& right,
                         Eigen::MatrixXd& solution)
{
  if (right.rows() == 1) return solve_components<1>(mass, right, solution);
  if (right.rows() == 2) return solve_components<2>(mass, right, solution);
  return solve_components<4>(mass, right, solution);
}

} // namespace mullion::surface
