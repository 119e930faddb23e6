#include "duct_radiation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mullion::elastic_solid {
namespace {

using Complex = std::complex<double>;
constexpr Complex i{0.0, 1.0};
constexpr double pi = std::numbers::pi;

/// Gauss's points and weights on [-1, 1], eight of them: the positive half.
constexpr double gauss_points[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
constexpr double gauss_weights[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};

/// int over [-1, 1] of exp(-i z xi)/2 and of xi exp(-i z xi)/2.
std::pair<Complex, Complex> moments(Complex z)
{
  if (std::abs(z) < 1e-2) { // the quotients lose digits; the next terms are below 1e-16 and 1e-13 of these
    const Complex s = z * z;
    return {1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0)), -i * z / 3.0 * (1.0 - s / 10.0 * (1.0 - s / 28.0))};
  }
  const Complex sine = std::sin(z), cosine = std::cos(z);
  return {sine / z, i * (z * cosine - sine) / (z * z)};
}

/// cot(alpha H)/alpha: even in alpha, so that either root will do; the one with Im >= 0 does not overflow.
Complex gas_response(Complex alpha_squared, double height)
{
  Complex alpha = std::sqrt(alpha_squared);
  if (alpha.imag() < 0.0) alpha = -alpha;
  const Complex wave = std::exp(2.0 * i * alpha * height);
  return i * (wave + 1.0) / (wave - 1.0) / alpha;
}

} // namespace

std::vector<WallPiece> wall_of(const Eigen::MatrixXd& nodes, const Surface& surface, const Eigen::MatrixXd& shape)
{
  const Eigen::MatrixXd normals = nodal_normals(nodes, surface);
  Eigen::VectorXd w(nodes.cols());
  for (Eigen::Index n = 0; n < nodes.cols(); ++n) {
    if (std::abs(normals(1, n)) < 1e-3 * normals.col(n).norm()) return {};
    w[n] = shape(0, n) * normals(0, n) / normals(1, n) + shape(1, n);
  }
  std::vector<WallPiece> wall;
  for (const auto& face : surface.faces) {
    auto a = face[0], b = face[1];
    if (nodes(0, a) > nodes(0, b)) std::swap(a, b);
    if (nodes(0, a) == nodes(0, b)) return {};
    wall.push_back({nodes(0, a), nodes(0, b), w[a], w[b]});
  }
  return wall;
}

Complex wall_transform(const std::vector<WallPiece>& wall, Complex k)
{
  Complex sum = 0.0;
  for (const auto& piece : wall) {
    const double length = piece.x_end - piece.x_begin, middle = 0.5 * (piece.x_begin + piece.x_end);
    const auto [mean, slope] = moments(0.5 * length * k);
    sum += length * std::exp(-i * k * middle) *
           (0.5 * (piece.w_begin + piece.w_end) * mean + 0.5 * (piece.w_end - piece.w_begin) * slope);
  }
  return sum;
}

Complex duct_load(const std::vector<WallPiece>& wall, double depth, double omega, const Duct& duct)
{
  const double U = duct.speed, c = duct.sound_speed, mach = U / c;
  double first = wall.front().x_begin, last = wall.front().x_end, shortest = last - first;
  for (const auto& piece : wall) {
    first = std::min(first, piece.x_begin);
    last = std::max(last, piece.x_end);
    shortest = std::min(shortest, piece.x_end - piece.x_begin);
  }
  // The poles lie in pairs about k_0, at real distances (waves) or imaginary ones. With omega + i 0 those at the right
  // move up and those at the left down: the path k = k_0 + s - i s/sqrt(1 + (L s)^2) passes between them, no further
  // than 1/L from the real axis, where |w^(k)|^2 = w^(k) w^(-k) grows no more than by e.
  const double length = last - first, centre = -omega / c * mach / (1.0 - mach * mach);
  const auto value_at = [&](double s) {
    const double root = std::sqrt(1.0 + length * length * s * s);
    const Complex k = centre + s - i * s / root, dk = 1.0 - i / (root * root * root);
    const Complex rate = omega - U * k; // omega as the gas sees it
    const Complex alpha_squared = rate * rate / (c * c) - k * k;
    return rate * rate * gas_response(alpha_squared, duct.height) * wall_transform(wall, k) * wall_transform(wall, -k) *
           dk;
  };
  const auto over = [&](double begin, double end) { // on both sides of k_0
    Complex sum = 0.0;
    const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
    for (std::size_t g = 0; g < std::size(gauss_points); ++g)
      for (const double s : {middle - half * gauss_points[g], middle + half * gauss_points[g]})
        sum += gauss_weights[g] * half * (value_at(s) + value_at(-s));
    return sum;
  };
  // Intervals grow from the middle on, where close to a cut-on two poles pinch the path; then they follow the
  // oscillation of |w^(k)|^2, of period 2 pi/L, and the spacing of poles across the duct. The end is where the pieces,
  // being straight, leave nothing of interest: w^ falls as 1/k^2.
  const double widest = std::min(pi / length, pi / duct.height), end = 8.0 * pi / shortest;
  Complex sum = 0.0;
  double s = 0.0, width = 1e-9 / length;
  while (s < end) {
    sum += over(s, s + width);
    s += width;
    // Beyond a few times omega/c and 1/H, cot is -i but for exp(-2 |k| H): only the wall's own period counts.
    const bool is_far = s > 4.0 * omega / (c * (1.0 - std::abs(mach))) + 8.0 / duct.height;
    width = std::min(2.0 * width, is_far ? pi / length : widest);
  }
  return depth * duct.density * sum / (2.0 * pi);
}

Radiation duct_radiation(const std::vector<WallPiece>& wall, double depth, double omega, const Duct& duct)
{
  const Complex change = duct_load(wall, depth, omega, duct) / (2.0 * omega); // of omega
  return {change.imag(), change.real() / (2.0 * pi)};
}

} // namespace mullion::elastic_solid
