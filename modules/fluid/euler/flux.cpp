// The two flux functions as loops without branches.
#include "flux.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

[[gnu::always_inline]] inline double larger(double a, double b) { return a > b ? a : b; }
[[gnu::always_inline]] inline double smaller(double a, double b) { return a < b ? a : b; }

template <int D> [[gnu::always_inline]] inline void hllc_loop(const Gas& gas, FaceBatch<D>& batch, std::size_t n)
{
  const double g = gas.gamma;
  const double per_g1 = 1.0 / (g - 1.0);
  constexpr int P = D + 1; // the pressure's row
  for (std::size_t k = 0; k < n; ++k) {
    const double s = batch.speed[k], area = batch.area[k];
    const double rho_l = batch.left[0][k], rho_r = batch.right[0][k];
    const double p_l = batch.left[P][k], p_r = batch.right[P][k];
    double normal[D], left[D], right[D];
    double u_l = 0.0, u_r = 0.0, square_l = 0.0, square_r = 0.0;
    for (int d = 0; d < D; ++d) {
      normal[d] = batch.normal[d][k];
      left[d] = batch.left[d + 1][k];
      right[d] = batch.right[d + 1][k];
      u_l += left[d] * normal[d];
      u_r += right[d] * normal[d];
      square_l += left[d] * left[d];
      square_r += right[d] * right[d];
    }
    const double e_l = p_l * per_g1 + 0.5 * rho_l * square_l; // rho E
    const double e_r = p_r * per_g1 + 0.5 * rho_r * square_r;
    const double per_rho_l = 1.0 / rho_l, per_rho_r = 1.0 / rho_r;
    const double c_l = std::sqrt(g * p_l * per_rho_l), c_r = std::sqrt(g * p_r * per_rho_r);

    // Roe's means along the normal; of the whole velocity for c.
    const double weight_r = std::sqrt(rho_r * per_rho_l);
    const double to_mean = 1.0 / (1.0 + weight_r);
    const double u = (u_l + weight_r * u_r) * to_mean;
    const double enthalpy = ((e_l + p_l) * per_rho_l + weight_r * (e_r + p_r) * per_rho_r) * to_mean;
    double square = 0.0;
    for (int d = 0; d < D; ++d) {
      const double mean = (left[d] + weight_r * right[d]) * to_mean;
      square += mean * mean;
    }
    const double c = std::sqrt(larger((g - 1.0) * (enthalpy - 0.5 * square), 0.0));

    const double s_l = smaller(u_l - c_l, u - c), s_r = larger(u_r + c_r, u + c);
    const double m_l = rho_l * (s_l - u_l), m_r = rho_r * (s_r - u_r); // < 0 and > 0
    const double s_m = (p_r - p_l + m_l * u_l - m_r * u_r) / (m_l - m_r);

    const double to_left = s_m - s; // >= 0: the face lies left of the contact
    const double rho_k = to_left >= 0.0 ? rho_l : rho_r;
    const double u_k = to_left >= 0.0 ? u_l : u_r;
    const double p_k = to_left >= 0.0 ? p_l : p_r;
    const double e_k = to_left >= 0.0 ? e_l : e_r;
    const double s_k = to_left >= 0.0 ? s_l : s_r;
    const double beyond = to_left >= 0.0 ? s_l - s : s - s_r; // >= 0: beyond the outer wave

    const double per_width = 1.0 / (s_k - s_m);
    const double p_star = p_k + rho_k * (s_k - u_k) * (s_m - u_k);
    const double e_star = (e_k * (s_k - u_k) - p_k * u_k + p_star * s_m) * per_width;
    const double rho_star = rho_k * (s_k - u_k) * per_width;
    const double density = beyond >= 0.0 ? rho_k : rho_star;
    const double velocity = beyond >= 0.0 ? u_k : s_m;
    const double pressure = beyond >= 0.0 ? p_k : p_star;
    const double energy = beyond >= 0.0 ? e_k : e_star;

    const double mass = density * (velocity - s) * area;
    const double push = pressure * area;
    batch.flux[0][k] = mass;
    for (int d = 0; d < D; ++d) {
      const double own = to_left >= 0.0 ? left[d] : right[d];
      batch.flux[d + 1][k] = mass * (own + (velocity - u_k) * normal[d]) + push * normal[d];
    }
    batch.flux[P][k] = energy * (velocity - s) * area + push * velocity;
  }
}

#if defined(__x86_64__)
// Four faces at a time where the processor can. The bits are the same: each operation is rounded by itself, no product
// is contracted with a sum (-ffp-contract=off).
template <int D> [[gnu::target("avx2")]] void hllc_wide(const Gas& gas, FaceBatch<D>& batch, std::size_t n)
{
  hllc_loop<D>(gas, batch, n);
}
#endif

} // namespace

template <int D> void hllc_fluxes(const Gas& gas, FaceBatch<D>& batch, std::size_t n, Width width)
{
#if defined(__x86_64__)
  static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
  if (is_wide && width == Width::best) return hllc_wide<D>(gas, batch, n);
#endif
  hllc_loop<D>(gas, batch, n);
}

template <int D> void roe_fluxes(const Gas& gas, FaceBatch<D>& batch, std::size_t n)
{
  const double g = gas.gamma;
  const double per_g1 = 1.0 / (g - 1.0);
  constexpr int P = D + 1;
  const auto rounded = [](double x, double delta) { // |x|, a parabola below delta
    const double size = std::abs(x);
    return size < delta ? 0.5 * (x * x / delta + delta) : size;
  };
  for (std::size_t k = 0; k < n; ++k) {
    const double s = batch.speed[k];
    const double rho_l = batch.left[0][k], rho_r = batch.right[0][k];
    const double p_l = batch.left[P][k], p_r = batch.right[P][k];
    double u_l = 0.0, u_r = 0.0, square_l = 0.0, square_r = 0.0;
    for (int d = 0; d < D; ++d) {
      const double nd = batch.normal[d][k], ul = batch.left[d + 1][k], ur = batch.right[d + 1][k];
      u_l += ul * nd;
      u_r += ur * nd;
      square_l += ul * ul;
      square_r += ur * ur;
    }
    const double e_l = p_l * per_g1 + 0.5 * rho_l * square_l;
    const double e_r = p_r * per_g1 + 0.5 * rho_r * square_r;
    const double weight_r = std::sqrt(rho_r / rho_l);
    const double to_mean = 1.0 / (1.0 + weight_r);
    const double rho = rho_l * weight_r;
    const double u = (u_l + weight_r * u_r) * to_mean;
    const double enthalpy = ((e_l + p_l) / rho_l + weight_r * (e_r + p_r) / rho_r) * to_mean;
    std::array<double, D> mean{};
    double square = 0.0;
    for (int d = 0; d < D; ++d) {
      mean[d] = (batch.left[d + 1][k] + weight_r * batch.right[d + 1][k]) * to_mean;
      square += mean[d] * mean[d];
    }
    const double c = std::sqrt(larger((g - 1.0) * (enthalpy - 0.5 * square), 0.0));
    const double dp = p_r - p_l, du = u_r - u_l, d_rho = rho_r - rho_l;
    const double delta = 0.05 * c;
    const double a1 = rounded(u - s - c, delta) * (dp - rho * c * du) / (2.0 * c * c);
    const double a2 = std::abs(u - s) * (d_rho - dp / (c * c));
    const double a3 = rounded(u - s + c, delta) * (dp + rho * c * du) / (2.0 * c * c);
    const double shear = std::abs(u - s) * rho;

    const double half = 0.5 * batch.area[k];
    const double mass_l = rho_l * (u_l - s), mass_r = rho_r * (u_r - s);
    batch.flux[0][k] = half * (mass_l + mass_r - (a1 + a2 + a3));
    double work = 0.0; // of the jump of the tangential velocity
    for (int d = 0; d < D; ++d) {
      const double nd = batch.normal[d][k];
      const double jump = batch.right[d + 1][k] - batch.left[d + 1][k] - du * nd;
      work += mean[d] * jump;
      const double waves = a1 * (mean[d] - c * nd) + a2 * mean[d] + a3 * (mean[d] + c * nd) + shear * jump;
      batch.flux[d + 1][k] =
          half * (mass_l * batch.left[d + 1][k] + mass_r * batch.right[d + 1][k] + (p_l + p_r) * nd - waves);
    }
    const double waves = a1 * (enthalpy - c * u) + a2 * 0.5 * square + a3 * (enthalpy + c * u) + shear * work;
    batch.flux[P][k] = half * (e_l * (u_l - s) + p_l * u_l + e_r * (u_r - s) + p_r * u_r - waves);
  }
}

template void hllc_fluxes<2>(const Gas&, FaceBatch<2>&, std::size_t, Width);
template void hllc_fluxes<3>(const Gas&, FaceBatch<3>&, std::size_t, Width);
template void roe_fluxes<2>(const Gas&, FaceBatch<2>&, std::size_t);
template void roe_fluxes<3>(const Gas&, FaceBatch<3>&, std::size_t);

} // namespace mullion::euler
