// Gradients within cells and their limiters: how values get from the centroids to the faces.
#pragma once

#include "gas.hpp"
#include "lanes.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace mullion::euler {

enum class Limiter { none, venkatakrishnan, barth_jespersen };

template <int D> struct LimiterOptions {
  Limiter limiter = Limiter::none;
  double k = 5.0;        ///< of venkatakrishnan: 0.3 for shocks, 5 for smooth flows
  double length = 1.0;   ///< L_ref [m]
  Values<D> reference{}; ///< of each variable: density, speed, pressure
};

template <int D> using Gradient = std::array<Values<D>, D>; ///< of (rho, u, p): d/dx, d/dy, …
template <int D> using Slopes = std::array<Row<D>, D>;      ///< the same, to compute with

/// How far the values of the stencil lie below and above the cell's own.
template <int D> struct Spread {
  Row<D> below{}, above{}; ///< <= 0 and >= 0
};

/// One cell of the stencil more: its gradient weight and how much its values differ.
template <int D>
MULLION_INLINE void add_to_gradient(const std::array<double, D>& weight, const Row<D>& jump, Slopes<D>& slopes,
                                    Spread<D>& spread)
{
  for (int d = 0; d < D; ++d) slopes[d] += weight[d] * jump;
  spread.below = jump < spread.below ? jump : spread.below;
  spread.above = jump > spread.above ? jump : spread.above;
}

/// W + grad W . offset. Not checked: see is_gas().
template <int D>
MULLION_INLINE Row<D> value_at(const Row<D>& w, const Gradient<D>& gradient, const std::array<double, D>& offset)
{
  Row<D> face = w;
  for (int d = 0; d < D; ++d) face += row_of<D>(gradient[d]) * offset[d];
  return face;
}

/// Shrinks a gradient, each variable by its own factor: the least over the faces of the cell.
///
///     venkatakrishnan:  psi = (a^2 + e^2 + 2 a b) / (a^2 + a b + 2 b^2 + e^2),  e^2 = ref^2 (k h / L_ref)^3
///     barth_jespersen:  psi = min(1, a / b)
///
/// with b the change from the centroid to the face's middle and a the spread in b's direction (venkatakrishnan1995,
/// barth1989).
///
/// @param offset  offset(k): from the centroid to the middle of the cell's k-th face, as an array of D numbers
template <int D, class Offset>
MULLION_INLINE void limit_gradient(const LimiterOptions<D>& options, double volume, const Spread<D>& spread,
                                   std::size_t n_faces, const Offset& offset, Slopes<D>& slopes)
{
  const double h_cubed = D == 2 ? volume * std::sqrt(volume) : volume;
  const double part = options.k / options.length;
  const double scale = part * part * part * h_cubed;
  const auto reference = row_of<D>(options.reference);
  const Row<D> smooth = reference * reference * scale;
  const bool is_smooth = options.limiter == Limiter::venkatakrishnan;
  // The least quotient is found by products, and only that one is divided out. 0 / 0, without slope and spread, is
  // never less: there is nothing to limit.
  Row<D> least = Row<D>{} + 1.0, per = least;
  for (std::size_t k = 0; k < n_faces; ++k) {
    const std::array<double, D>& to_face = offset(k);
    Row<D> b{};
    for (int d = 0; d < D; ++d) b += slopes[d] * to_face[d];
    const Row<D> a = b < 0.0 ? spread.below : spread.above; // of b's sign
    Row<D> above, below;
    if (is_smooth) {
      const Row<D> common = a * a + smooth;
      above = common + 2.0 * a * b;
      below = common + b * (a + 2.0 * b);
    } else {
      above = size_of<Row<D>>(a);
      below = size_of<Row<D>>(b);
    }
    const auto is_less = above * per < least * below;
    least = is_less ? above : least;
    per = is_less ? below : per;
  }
  for (int d = 0; d < D; ++d) slopes[d] *= least / per;
}

} // namespace mullion::euler
