// Numbers that a run's summary draws from its history: how large an oscillation is, how fast, and whether it
// grows. Pure functions of samples; they know neither files nor windows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mullion::run {

/// Half of max - min; 0 without values.
[[nodiscard]] double amplitude(std::span<const double> values);

/// The frequency of the strongest oscillation [1/unit of times]: the maximum of the Hann-windowed spectrum
///
///     |X(f)|^2,   X(f) = sum_i w_i v_i exp(-2 pi i f t_i),   w_i = (1 - cos(2 pi (i + 1/2) / N)) / 2
///
/// of the values less their mean and linear trend; found on a zero-padded grid, refined by Newton's method to
/// 1e-10 relative. What remains is the leakage of the window and the trend, at the worst phase of a pure sine 5e-2
/// relative at 2 periods, 4e-3 at 3, 1e-5 at 10, 1e-6 at 20. growth_rate() refines further.
///
/// @param times   increasing, equal steps; the last one may be shorter (a run's last step is)
/// @param values  as many
/// @return        0 if fewer than about two periods (1.9) are seen, or nothing oscillates
/// @throws Error  Errc::shape: lengths differ or steps are unequal; Errc::numeric: a value is not finite
[[nodiscard]] double dominant_frequency(std::span<const double> times, std::span<const double> values);

struct SpectralPeak {
  double frequency = 0.0; ///< [1/unit of times]
  double height = 1.0;    ///< |X| over that of the strongest peak
};

/// The tops of the spectrum that dominant_frequency() looks at, the highest first, each found as well as that one. One
/// within four periods per record of a higher top is left out: it may be the window's side lobe.
///
/// @param n_peaks  at most so many
/// @return         of 1.9 periods and above; none if the highest of all is below, as dominant_frequency finds none then
/// @throws Error   as dominant_frequency
[[nodiscard]] std::vector<SpectralPeak> spectral_peaks(std::span<const double> times, std::span<const double> values,
                                                       std::size_t n_peaks);

struct Growth {
  double sigma = 0.0;             ///< [1/unit of times] positive: growing
  double frequency = 0.0;         ///< refined
  double relative_residual = 1.0; ///< |v - fit| / |v - mean|: near 0 if the model holds, 1 if nothing was found
};

/// Fit exp(sigma t) (A cos 2 pi f t + B sin 2 pi f t) + C + D t by least squares (Levenberg-Marquardt in sigma and
/// f, the rest being linear), starting from the given frequency and the growth of the amplitude over windows of
/// two periods.
///
/// @param times      increasing, not necessarily in equal steps
/// @param frequency  a guess, as dominant_frequency() gives it; 0: returns {}
/// @return           {} with residual 1 if there are fewer than 8 samples or nothing varies
/// @throws Error     as dominant_frequency, steps aside
[[nodiscard]] Growth growth_rate(std::span<const double> times, std::span<const double> values, double frequency);

} // namespace mullion::run
