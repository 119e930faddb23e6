// Gradients within cells and their limiters: how values get from the centroids to the faces.
#pragma once

#include "gas.hpp"

#include <algorithm>
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

/// How far the values of the stencil lie below and above the cell's own.
template <int D> struct Spread {
  Values<D> below{}, above{}; ///< <= 0 and >= 0
};

/// W + grad W . offset; W itself where that is no gas.
template <int D>
inline Values<D> value_at(const Values<D>& w, const Gradient<D>& gradient, const std::array<double, D>& offset)
{
  Values<D> face = w;
  for (int d = 0; d < D; ++d)
    for (std::size_t v = 0; v < w.size(); ++v) face[v] += gradient[d][v] * offset[d];
  return is_gas<D>(face) ? face : w;
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
[[gnu::always_inline]] inline void limit_gradient(const LimiterOptions<D>& options, double volume,
                                                  const Spread<D>& spread, std::size_t n_faces, const Offset& offset,
                                                  Gradient<D>& gradient)
{
  constexpr std::size_t n = n_values<D>;
  Values<D> factor, smooth;
  const double h_cubed = D == 2 ? volume * std::sqrt(volume) : volume;
  const double part = options.k / options.length;
  const double scale = part * part * part * h_cubed;
  for (std::size_t v = 0; v < n; ++v) {
    factor[v] = 1.0;
    smooth[v] = options.reference[v] * options.reference[v] * scale;
  }
  const bool is_smooth = options.limiter == Limiter::venkatakrishnan;
  for (std::size_t k = 0; k < n_faces; ++k) {
    const std::array<double, D>& to_face = offset(k);
    Values<D> a, b{};
    for (int d = 0; d < D; ++d)
      for (std::size_t v = 0; v < n; ++v) b[v] += gradient[d][v] * to_face[d];
    for (std::size_t v = 0; v < n; ++v) a[v] = b[v] < 0.0 ? spread.below[v] : spread.above[v];
    if (is_smooth) {
      for (std::size_t v = 0; v < n; ++v) {
        const double common = a[v] * a[v] + smooth[v];
        const double below = common + b[v] * (a[v] + 2.0 * b[v]);
        const double psi = (common + 2.0 * a[v] * b[v]) / below;
        factor[v] = psi < factor[v] ? psi : factor[v]; // 0 / 0 without slope and spread: nothing to limit
      }
    } else {
      for (std::size_t v = 0; v < n; ++v) {
        const double psi = a[v] / b[v]; // no number without a slope
        factor[v] = psi < factor[v] ? psi : factor[v];
      }
    }
  }
  for (int d = 0; d < D; ++d)
    for (std::size_t v = 0; v < n; ++v) gradient[d][v] *= factor[v];
}

} // namespace mullion::euler
