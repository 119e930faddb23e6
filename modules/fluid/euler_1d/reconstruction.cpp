// Slopes and face values.
#include "reconstruction.hpp"

#include <cstddef>

namespace mullion::euler_1d {

namespace {

double limited(double a, double b, Limiter limiter)
{
  if (limiter == Limiter::none) return 0.5 * (a + b);
  const double product = a * b;
  return product > 0.0 ? product * (a + b) / (a * a + b * b) : 0.0; // a b > 0: the quotient exists
}

double extrapolated(double end, double neighbour, double fraction) { return end + (end - neighbour) * fraction; }

} // namespace

Primitive end_value(const Primitive& end_cell, double end_length, const Primitive& neighbour, double neighbour_length)
{
  const double fraction = end_length / (end_length + neighbour_length);
  return {extrapolated(end_cell.density, neighbour.density, fraction),
          extrapolated(end_cell.velocity, neighbour.velocity, fraction),
          extrapolated(end_cell.pressure, neighbour.pressure, fraction)};
}

void reconstruct(std::span<const Primitive> cells, std::span<const double> length, Limiter limiter,
                 std::span<Primitive> left_value, std::span<Primitive> right_value)
{
  const std::size_t n = cells.size();
  if (n == 1) {
    left_value[0] = right_value[0] = cells[0];
    return;
  }

  for (std::size_t i = 1; i + 1 < n; ++i) {
    const double half = 0.5 * length[i];
    const double to_left = 2.0 / (length[i - 1] + length[i]);
    const double to_right = 2.0 / (length[i] + length[i + 1]);
    const auto face_values = [&](double Primitive::*q) {
      const double step = half * limited((cells[i].*q - cells[i - 1].*q) * to_left,
                                         (cells[i + 1].*q - cells[i].*q) * to_right, limiter);
      left_value[i].*q = cells[i].*q - step;
      right_value[i].*q = cells[i].*q + step;
    };
    face_values(&Primitive::density);
    face_values(&Primitive::velocity);
    face_values(&Primitive::pressure);
  }

  // End cells: the outer face by extrapolation, the inner face by the mirror image of the same
  // slope.
  const auto end_cell = [&](std::size_t e, std::size_t neighbour, Primitive& outer, Primitive& inner) {
    const Primitive& q = cells[e];
    outer = end_value(q, length[e], cells[neighbour], length[neighbour]);
    inner = {q.density - (outer.density - q.density), q.velocity - (outer.velocity - q.velocity),
             q.pressure - (outer.pressure - q.pressure)};
  };
  end_cell(0, 1, left_value[0], right_value[0]);
  end_cell(n - 1, n - 2, right_value[n - 1], left_value[n - 1]);
}

} // namespace mullion::euler_1d
