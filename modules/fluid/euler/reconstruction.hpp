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

template <int D> using Gradient = std::array<std::array<double, D>, n_values<D>>; ///< of (rho, u, p)

/// How far the values of the stencil lie below and above the cell's own.
template <int D> struct Spread {
  Values<D> below{}, above{}; ///< <= 0 and >= 0
};

/// W + grad W . offset; W itself where that is no gas.
template <int D>
inline Values<D> value_at(const Values<D>& w, const Gradient<D>& gradient, const std::array<double, D>& offset)
{
  Values<D> face;
  for (std::size_t v = 0; v < w.size(); ++v) {
    face[v] = w[v];
    for (int d = 0; d < D; ++d) face[v] += gradient[v][d] * offset[d];
  }
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
inline void limit_gradient(const LimiterOptions<D>& options, double volume, const Spread<D>& spread,
                           std::size_t n_faces, const Offset& offset, Gradient<D>& gradient)
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
    for (std::size_t v = 0; v < n; ++v) {
      double b = 0.0;
      for (int d = 0; d < D; ++d) b += gradient[v][d] * to_face[d];
      const double a = b < 0.0 ? spread.below[v] : spread.above[v];
      double psi;
      if (is_smooth) {
        const double common = a * a + smooth[v];
        const double below = common + b * (a + 2.0 * b);
        psi = below > 0.0 ? (common + 2.0 * a * b) / below : 1.0; // no slope, no spread: nothing to limit
      } else {
        psi = std::abs(b) > std::abs(a) ? a / b : 1.0;
      }
      factor[v] = psi < factor[v] ? psi : factor[v];
    }
  }
  for (std::size_t v = 0; v < n; ++v)
    for (int d = 0; d < D; ++d) gradient[v][d] *= factor[v];
}

} // namespace mullion::euler
