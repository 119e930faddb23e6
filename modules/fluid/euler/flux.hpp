// Numerical fluxes through moving faces, for many faces at a time: structure of arrays, so that the loop over them has
// no branches and the compiler turns it into vector instructions. Which states meet at a face is decided elsewhere.
#pragma once

#include "gas.hpp"

#include <array>
#include <cstddef>

namespace mullion::euler {

enum class Flux { hllc, roe };
enum class Width { best, baseline };

/// States on both sides of up to `capacity` faces, (rho, u, p), and the fluxes between them.
template <int D> struct FaceBatch {
  static constexpr std::size_t capacity = 128;
  using Row = std::array<double, capacity>;

  alignas(64) std::array<Row, n_values<D>> left, right;
  alignas(64) std::array<Row, D> normal;         ///< unit, from left to right
  alignas(64) Row area;                          ///< [m^2; m in the plane]
  alignas(64) Row speed;                         ///< s of the face along its normal [m/s]
  alignas(64) std::array<Row, n_values<D>> flux; ///< times the area
};

/// HLLC with respect to faces that move with s: its waves are compared with s, not with 0.
///
///     S_L = min(u_L - c_L, u~ - c~), S_R = max(u_R + c_R, u~ + c~)      u~, c~: Roe's means
///     S_M = (p_R - p_L + m_L u_L - m_R u_R) / (m_L - m_R),  m_K = rho_K (S_K - u_K)
///     F   = F(w_K) - s w_K on the side where s lies beyond the outer wave, else of the star state on its side
///
/// toro2009 section 10.4, batten1997.
///
/// @param width  which vector instructions: the widest that there are, or those that every processor has. The bits of
///               the result are the same; for tests.
template <int D> void hllc_fluxes(const Gas& gas, FaceBatch<D>& batch, std::size_t n, Width width = Width::best);

/// Roe's flux difference splitting, |u - s -+ c| rounded below 0.05 c~ (roe1981, harten1983).
template <int D> void roe_fluxes(const Gas& gas, FaceBatch<D>& batch, std::size_t n);

} // namespace mullion::euler
