// Numerical fluxes through moving faces, of a number type: for one face, or for several at a time (lanes.hpp), with the
// same bits and without branches. Which states meet at a face is decided elsewhere.
#pragma once

#include "gas.hpp"
#include "lanes.hpp"

#include <array>
#include <cstddef>

namespace mullion::euler {

enum class Flux { hllc, roe };

/// A face and the states on its sides, (rho, u, p).
template <int D, class T> struct FaceStates {
  std::array<T, n_values<D>> left, right;
  std::array<T, D> normal; ///< unit, from left to right
  T area;                  ///< [m^2; m in the plane]
  T speed;                 ///< s of the face along its normal [m/s]
};

/// HLLC with respect to faces that move with s: its waves are compared with s, not with 0.
///
///     S_L = min(u_L - c_L, u~ - c~), S_R = max(u_R + c_R, u~ + c~)      u~, c~: Roe's means
///     S_M = (p_R - p_L + m_L u_L - m_R u_R) / (m_L - m_R),  m_K = rho_K (S_K - u_K)
///     F   = F(w_K) - s w_K on the side where s lies beyond the outer wave, else of the star state on its side
///
/// toro2009 section 10.4, batten1997. With the weight b = sqrt(rho_R) / (sqrt(rho_L) + sqrt(rho_R)) the means are
///
///     u~ = u_L + b (u_R - u_L),  c~^2 = c_L^2 + b (c_R^2 - c_L^2) + (gamma - 1) / 2 b (1 - b) |u_R - u_L|^2
///
/// which is einfeldt1988's form and cannot be negative. Quotients share two divisions: a division takes as long as
/// twenty products.
///
/// It comes in three parts, so that a loop over each of them has the roots and quotients of several groups of faces
/// under way.
template <class T> struct HllcMeans {
  T b, cc_l, cc_r; ///< the weight, and the squares of the sound speeds
};
template <class T> struct HllcWaves {
  T u_l, u_r, s_l, s_r; ///< of the gas along the normal, and of the outer waves
};

template <int D, class T> MULLION_INLINE HllcMeans<T> hllc_means(const Gas& gas, const FaceStates<D, T>& face)
{
  constexpr int P = D + 1; // the pressure
  const auto& [left, right, normal, area, s] = face;
  const T rho_l = left[0], rho_r = right[0], p_l = left[P], p_r = right[P];
  const T product = rho_l * rho_r, mean_rho = root<T>(product);
  const T both = rho_l + mean_rho;
  const T share = 1.0 / (product * both);
  return {mean_rho * product * share, gas.gamma * p_l * (rho_r * both * share),
          gas.gamma * p_r * (rho_l * both * share)};
}

template <int D, class T>
MULLION_INLINE HllcWaves<T> hllc_waves(const Gas& gas, const FaceStates<D, T>& face, const HllcMeans<T>& means)
{
  const auto& [left, right, normal, area, s] = face;
  const auto& [b, cc_l, cc_r] = means;
  T u_l{}, u_r{}, jump{};
  for (int d = 0; d < D; ++d) {
    u_l += left[d + 1] * normal[d];
    u_r += right[d + 1] * normal[d];
    const T apart = right[d + 1] - left[d + 1];
    jump += apart * apart;
  }
  const T c_l = root<T>(cc_l), c_r = root<T>(cc_r);
  const T u = u_l + b * (u_r - u_l);
  const T c = root<T>(cc_l + b * (cc_r - cc_l) + 0.5 * (gas.gamma - 1.0) * (b - b * b) * jump);
  const T lowest_l = u_l - c_l, lowest = u - c, highest_r = u_r + c_r, highest = u + c;
  return {u_l, u_r, lowest_l < lowest ? lowest_l : lowest, highest_r > highest ? highest_r : highest};
}

/// The last part.
/// @return  (rho, rho u, rho E) through the face, times its area
template <int D, class T>
MULLION_INLINE std::array<T, n_values<D>> hllc_flux(const Gas& gas, const FaceStates<D, T>& face,
                                                    const HllcWaves<T>& waves)
{
  constexpr int P = D + 1; // the pressure
  const auto& [left, right, normal, area, s] = face;
  const auto& [u_l, u_r, s_l, s_r] = waves;
  const T rho_l = left[0], rho_r = right[0], p_l = left[P], p_r = right[P];
  T square_l = left[1] * left[1], square_r = right[1] * right[1];
  for (int d = 2; d <= D; ++d) {
    square_l += left[d] * left[d];
    square_r += right[d] * right[d];
  }
  const T m_l = rho_l * (s_l - u_l), m_r = rho_r * (s_r - u_r);         // < 0 and > 0
  const T above = p_r - p_l + m_l * u_l - m_r * u_r, below = m_l - m_r; // S_M = above / below, below < 0

  const auto is_left = above <= s * below; // S_M >= s: the face lies left of the contact
  const T rho_k = is_left ? rho_l : rho_r;
  const T u_k = is_left ? u_l : u_r;
  const T p_k = is_left ? p_l : p_r;
  const T s_k = is_left ? s_l : s_r;
  const T m_k = is_left ? m_l : m_r;
  const T square = is_left ? square_l : square_r;
  const T beyond = is_left ? s_l - s : s - s_r; // >= 0: beyond the outer wave

  const T width = s_k * below - above; // (S_K - S_M) (m_L - m_R)
  const T per_both = 1.0 / (below * width);
  const T s_m = above * width * per_both, per_width = below * below * per_both;
  const T e_k = p_k * (1.0 / (gas.gamma - 1.0)) + 0.5 * rho_k * square; // rho E
  const T p_star = p_k + m_k * (s_m - u_k);
  const T e_star = (e_k * (s_k - u_k) - p_k * u_k + p_star * s_m) * per_width;
  const auto is_outer = beyond >= 0.0;
  const T density = is_outer ? rho_k : m_k * per_width;
  const T velocity = is_outer ? u_k : s_m;
  const T pressure = is_outer ? p_k : p_star;
  const T energy = is_outer ? e_k : e_star;

  const T through = (velocity - s) * area, push = pressure * area;
  const T mass = density * through;
  const T along = mass * (velocity - u_k) + push;
  std::array<T, n_values<D>> flux;
  flux[0] = mass;
  for (int d = 0; d < D; ++d) flux[d + 1] = mass * (is_left ? left[d + 1] : right[d + 1]) + along * normal[d];
  flux[P] = energy * through + push * velocity;
  return flux;
}

/// All of it.
template <int D, class T>
MULLION_INLINE std::array<T, n_values<D>> hllc_flux(const Gas& gas, const FaceStates<D, T>& face)
{
  return hllc_flux<D, T>(gas, face, hllc_waves<D, T>(gas, face, hllc_means<D, T>(gas, face)));
}

/// Roe's flux difference splitting, |u - s -+ c| rounded below 0.05 c~ (roe1981, harten1983).
template <int D, class T>
MULLION_INLINE std::array<T, n_values<D>> roe_flux(const Gas& gas, const FaceStates<D, T>& face)
{
  constexpr int P = D + 1;
  const auto& [left, right, normal, area, s] = face;
  const double g = gas.gamma, per_g1 = 1.0 / (g - 1.0);
  const T rho_l = left[0], rho_r = right[0], p_l = left[P], p_r = right[P];
  T u_l{}, u_r{}, square_l{}, square_r{};
  for (int d = 0; d < D; ++d) {
    u_l += left[d + 1] * normal[d];
    u_r += right[d + 1] * normal[d];
    square_l += left[d + 1] * left[d + 1];
    square_r += right[d + 1] * right[d + 1];
  }
  const T e_l = p_l * per_g1 + 0.5 * rho_l * square_l, e_r = p_r * per_g1 + 0.5 * rho_r * square_r;
  const T weight_r = root<T>(rho_r / rho_l);
  const T to_mean = 1.0 / (1.0 + weight_r);
  const T rho = rho_l * weight_r;
  const T u = (u_l + weight_r * u_r) * to_mean;
  const T enthalpy = ((e_l + p_l) / rho_l + weight_r * (e_r + p_r) / rho_r) * to_mean;
  std::array<T, D> mean;
  T square{};
  for (int d = 0; d < D; ++d) {
    mean[d] = (left[d + 1] + weight_r * right[d + 1]) * to_mean;
    square += mean[d] * mean[d];
  }
  const T cc = (g - 1.0) * (enthalpy - 0.5 * square);
  const T c = root<T>(cc > 0.0 ? cc : T{});
  const T dp = p_r - p_l, du = u_r - u_l, d_rho = rho_r - rho_l;
  const T delta = 0.05 * c;
  const auto rounded = [&delta](const T& x) __attribute__((always_inline))->T
  { // |x|, a parabola below delta
    const T size = size_of<T>(x);
    return size < delta ? 0.5 * (x * x / delta + delta) : size;
  };
  const T a1 = rounded(u - s - c) * (dp - rho * c * du) / (2.0 * c * c);
  const T a2 = size_of<T>(u - s) * (d_rho - dp / (c * c));
  const T a3 = rounded(u - s + c) * (dp + rho * c * du) / (2.0 * c * c);
  const T shear = size_of<T>(u - s) * rho;

  const T half = 0.5 * area;
  const T mass_l = rho_l * (u_l - s), mass_r = rho_r * (u_r - s);
  std::array<T, n_values<D>> flux;
  flux[0] = half * (mass_l + mass_r - (a1 + a2 + a3));
  T work{}; // of the jump of the tangential velocity
  for (int d = 0; d < D; ++d) {
    const T jump = right[d + 1] - left[d + 1] - du * normal[d];
    work += mean[d] * jump;
    const T waves = a1 * (mean[d] - c * normal[d]) + a2 * mean[d] + a3 * (mean[d] + c * normal[d]) + shear * jump;
    flux[d + 1] = half * (mass_l * left[d + 1] + mass_r * right[d + 1] + (p_l + p_r) * normal[d] - waves);
  }
  const T waves = a1 * (enthalpy - c * u) + a2 * 0.5 * square + a3 * (enthalpy + c * u) + shear * work;
  flux[P] = half * (e_l * (u_l - s) + p_l * u_l + e_r * (u_r - s) + p_r * u_r - waves);
  return flux;
}

} // namespace mullion::euler
