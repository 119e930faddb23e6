#include "run/signal.hpp"

#include <mullion/sdk/error.hpp>

#include <Eigen/Dense>
#include <unsupported/Eigen/FFT>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <ranges>
#include <vector>

namespace mullion::run {
namespace {

constexpr double two_pi = 2.0 * std::numbers::pi;

void check_samples(std::span<const double> times, std::span<const double> values)
{
  MULLION_REQUIRE(times.size() == values.size(), Errc::shape, "a signal of {} values at {} times", values.size(),
                  times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    MULLION_REQUIRE(std::isfinite(times[i]) && std::isfinite(values[i]), Errc::numeric,
                    "sample {} of a signal is not finite: value {} at time {}", i, values[i], times[i]);
    MULLION_REQUIRE(i == 0 || times[i] > times[i - 1], Errc::shape,
                    "the times of a signal do not increase: {} after {} at sample {}", times[i], times[i - 1], i);
  }
}

/// How many samples, from the first, have equal steps: all, or all but the last; otherwise an error.
std::size_t n_uniform(std::span<const double> times)
{
  const auto n = times.size();
  const double step = (times[n - 2] - times[0]) / static_cast<double>(n - 2);
  const double rounding =
      4.0 * std::numeric_limits<double>::epsilon() * std::max(std::abs(times[0]), std::abs(times[n - 1]));
  const double tolerance = 1e-6 * step + rounding; // of a sample's place: far below what moves a frequency
  for (std::size_t i = 0; i + 1 < n; ++i)
    MULLION_REQUIRE(std::abs(times[i] - times[0] - static_cast<double>(i) * step) <= tolerance, Errc::shape,
                    "the frequency of a signal needs equal time steps; at time {} there is another than {}", times[i],
                    step);
  return std::abs(times[n - 1] - times[0] - static_cast<double>(n - 1) * step) <= tolerance ? n : n - 1;
}

/// What is left of a drift looks like one period and a half.
constexpr double fewest_periods = 1.9;

/// So many periods per record from a peak, the Hann window's side lobes are below 1/300 of it: what is higher there is
/// another oscillation, what is higher nearer by may be a side lobe.
constexpr double main_lobe = 4.0;

/// The values less their mean and linear trend, times the Hann window.
std::vector<double> windowed(std::span<const double> values)
{
  const auto n = static_cast<double>(values.size());
  const double centre = 0.5 * (n - 1.0);
  double mean = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) mean += values[i];
  mean /= n;
  for (std::size_t i = 0; i < values.size(); ++i) moment += (static_cast<double>(i) - centre) * (values[i] - mean);
  const double slope = moment / (n * (n * n - 1.0) / 12.0);
  std::vector<double> result(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto x = static_cast<double>(i);
    const double window = 0.5 - 0.5 * std::cos(two_pi * (x + 0.5) / n);
    result[i] = window * (values[i] - mean - slope * (x - centre));
  }
  return result;
}

/// S = |X|^2 at `turns` per sample, with its first and second derivative; a sample's number counts from the middle
/// and in units of N, so that the three are of one size.
struct Spectrum {
  double value, slope, curvature;
};

Spectrum spectrum_at(std::span<const double> signal, double turns)
{
  using Complex = std::complex<double>;
  constexpr std::size_t n_turned = 512; // samples before the rotation is set anew: bounds its rounding error
  const auto n = static_cast<double>(signal.size());
  const double centre = 0.5 * (n - 1.0);
  const Complex turn = std::polar(1.0, -two_pi * turns);
  Complex x0{}, x1{}, x2{};
  for (std::size_t begin = 0; begin < signal.size(); begin += n_turned) {
    const auto end = std::min(begin + n_turned, signal.size());
    Complex phase = std::polar(1.0, -two_pi * turns * (static_cast<double>(begin) - centre));
    for (std::size_t i = begin; i < end; ++i) {
      const double s = (static_cast<double>(i) - centre) / n;
      const Complex term = signal[i] * phase;
      x0 += term;
      x1 += s * term;
      x2 += (s * s) * term;
      phase = {phase.real() * turn.real() - phase.imag() * turn.imag(),
               phase.real() * turn.imag() + phase.imag() * turn.real()};
    }
  }
  // dX/df = -2 pi i sum s x: with u = f in periods per record, d/du
  const Complex d1 = Complex(0.0, -two_pi) * x1;
  const Complex d2 = -two_pi * two_pi * x2;
  return {std::norm(x0), 2.0 * (std::conj(x0) * d1).real(), 2.0 * (std::norm(d1) + (std::conj(x0) * d2).real())};
}

/// The place of the spectrum's maximum near `periods` (per record), found on a grid of spacing `width`.
double refine(std::span<const double> signal, double periods, double width)
{
  const auto n = static_cast<double>(signal.size());
  double low = std::max(0.0, periods - width), high = periods + width;
  for (int iteration = 0; iteration < 60; ++iteration) {
    const auto [value, slope, curvature] = spectrum_at(signal, periods / n);
    (slope > 0.0 ? low : high) = periods; // the maximum is where the slope changes its sign
    double next = periods - slope / curvature;
    if (curvature >= 0.0 || next <= low || next >= high) next = 0.5 * (low + high);
    const double change = std::abs(next - periods);
    periods = next;
    if (change <= 1e-10 * periods) break;
  }
  return periods;
}

// ---- growth -----------------------------------------------------------------------------------------------

/// sigma from the amplitude over windows of two periods (Hann: blind to a constant): the slope of log |X|.
double growth_guess(std::span<const double> times, std::span<const double> values, double frequency)
{
  const double length = 2.0 / frequency;
  double n = 0.0, sum_t = 0.0, sum_y = 0.0, sum_tt = 0.0, sum_ty = 0.0;
  std::size_t begin = 0;
  while (begin < times.size() && times[begin] + length <= times.back() + 0.01 * length) {
    std::complex<double> x{};
    double weight = 0.0;
    std::size_t i = begin;
    for (; i < times.size() && times[i] < times[begin] + length; ++i) {
      const double phase = (times[i] - times[begin]) / length;
      const double w = 0.5 - 0.5 * std::cos(two_pi * phase);
      x += w * values[i] * std::polar(1.0, -two_pi * 2.0 * phase);
      weight += w;
    }
    if (i - begin >= 8 && std::abs(x) > 0.0) {
      const double t = times[begin] - times.front(), y = std::log(std::abs(x) / weight);
      n += 1.0;
      sum_t += t;
      sum_y += y;
      sum_tt += t * t;
      sum_ty += t * y;
    }
    begin = std::max(i, begin + 1);
  }
  const double spread = n * sum_tt - sum_t * sum_t;
  return n < 2.0 || spread <= 0.0 ? 0.0 : (n * sum_ty - sum_t * sum_y) / spread;
}

/// The model in units of the record, exp(s tau) (a cos omega tau + b sin omega tau) + c + d tau: tau counts from the
/// end of the record at which the oscillation is largest, so that exp <= 1 and the derivatives hardly depend on each
/// other.
struct Model {
  double s, omega; ///< sigma T, 2 pi f T
  double a = 0.0, b = 0.0, c = 0.0, d = 0.0;
};
constexpr int n_unknowns = 6;

struct Normal {
  Eigen::Matrix<double, n_unknowns, n_unknowns> matrix;
  Eigen::Matrix<double, n_unknowns, 1> right;
  double square; ///< of the residual
};

class Fit {
public:
  Fit(std::span<const double> times, std::span<const double> values, double mean)
      : times_(times), values_(values), mean_(mean), length_(times.back() - times.front()),
        middle_(0.5 * (times.back() + times.front()))
  {
  }

  /// Sums for the derivatives to (s, omega, a, b, c, d) and the residual of the model.
  [[nodiscard]] Normal normal(const Model& m) const
  {
    Normal sums{decltype(Normal::matrix)::Zero(), decltype(Normal::right)::Zero(), 0.0};
    const double tau_0 = m.s >= 0.0 ? 0.5 : -0.5;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const double tau = (times_[i] - middle_) / length_ - tau_0;
      const double e = std::exp(m.s * tau);
      const double cosine = e * std::cos(m.omega * tau), sine = e * std::sin(m.omega * tau);
      const double wave = m.a * cosine + m.b * sine;
      const double r = values_[i] - mean_ - wave - m.c - m.d * tau;
      const double d[n_unknowns] = {tau * wave, tau * (m.b * cosine - m.a * sine), cosine, sine, 1.0, tau};
      for (int row = 0; row < n_unknowns; ++row) {
        for (int column = 0; column <= row; ++column) sums.matrix(row, column) += d[row] * d[column];
        sums.right(row) += d[row] * r;
      }
      sums.square += r * r;
    }
    sums.matrix = sums.matrix.selfadjointView<Eigen::Lower>();
    return sums;
  }

  /// The best a to d for the s and omega of `m`.
  void solve_linear(Model& m) const
  {
    const auto sums = normal({m.s, m.omega});
    const Eigen::Vector4d linear = sums.matrix.bottomRightCorner<4, 4>().ldlt().solve(sums.right.tail<4>());
    m.a = linear[0];
    m.b = linear[1];
    m.c = linear[2];
    m.d = linear[3];
  }

  [[nodiscard]] double length() const { return length_; }

private:
  std::span<const double> times_, values_;
  double mean_, length_, middle_;
};

/// Levenberg-Marquardt from `m`; returns the sum of the squared residuals.
double minimise(const Fit& fit, Model& m)
{
  auto sums = fit.normal(m);
  double damping = 1e-6;
  for (int iteration = 0; iteration < 40; ++iteration) {
    Eigen::Matrix<double, n_unknowns, n_unknowns> damped = sums.matrix;
    damped.diagonal() *= 1.0 + damping;
    const Eigen::Matrix<double, n_unknowns, 1> d = damped.ldlt().solve(sums.right);
    if (!d.allFinite()) break;
    Model next{m.s + d[0], m.omega + d[1], m.a + d[2], m.b + d[3], m.c + d[4], m.d + d[5]};
    if ((next.s >= 0.0) != (m.s >= 0.0)) fit.solve_linear(next); // tau_0 went to the other end
    const auto next_sums = fit.normal(next);
    if (!(next_sums.square <= sums.square)) { // no better, or NaN
      damping = std::max(1e-6, damping * 10.0);
      if (damping > 1e6) break;
      continue;
    }
    const bool is_done =
        std::abs(d[0]) <= 1e-10 * std::max(1.0, std::abs(next.s)) && std::abs(d[1]) <= 1e-11 * std::abs(next.omega);
    m = next;
    sums = next_sums;
    damping *= 0.1;
    if (is_done) break;
  }
  return sums.square;
}

} // namespace

double amplitude(std::span<const double> values)
{
  if (values.empty()) return 0.0;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return 0.5 * (*high - *low);
}

std::vector<SpectralPeak> spectral_peaks(std::span<const double> times, std::span<const double> values,
                                         std::size_t n_peaks)
{
  check_samples(times, values);
  if (times.size() < 9) return {}; // two periods of four samples, and their end
  const auto n = n_uniform(times);
  values = values.first(n);
  const double step = (times[n - 1] - times[0]) / static_cast<double>(n - 1);

  const auto signal = windowed(values);
  const double largest = std::abs(
      *std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  const double rounding = 64.0 * std::numeric_limits<double>::epsilon() * largest;
  if (amplitude(signal) <= rounding) return {}; // constant or linear but for rounding

  std::size_t padded = 1;
  while (padded < 2 * n) padded *= 2; // at least two points per bin of the record
  std::vector<double> input(padded, 0.0);
  std::copy(signal.begin(), signal.end(), input.begin());
  std::vector<std::complex<double>> spectrum;
  Eigen::FFT<double> fft;
  fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
  fft.fwd(spectrum, input);
  const double width = static_cast<double>(n) / static_cast<double>(padded); // periods per record, per point
  const auto is_new = [&](const std::vector<SpectralPeak>& found, std::size_t k) {
    return std::none_of(found.begin(), found.end(), [&](const SpectralPeak& peak) {
      return std::abs(static_cast<double>(k) * width - peak.frequency) < main_lobe;
    });
  };
  std::vector<SpectralPeak> peaks; // frequencies in periods per record
  while (peaks.size() < n_peaks) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < spectrum.size(); ++k) {
      const double there = std::norm(spectrum[k]);
      const bool is_top =
          there >= std::norm(spectrum[k - 1]) && (k + 1 == spectrum.size() || there >= std::norm(spectrum[k + 1]));
      const bool is_next = is_top && static_cast<double>(k) * width >= fewest_periods && is_new(peaks, k);
      if ((peaks.empty() || is_next) && (best == 0 || there > std::norm(spectrum[best]))) best = k;
    }
    if (best == 0) break;
    const double periods = refine(signal, static_cast<double>(best) * width, width);
    if (periods < fewest_periods) break;
    peaks.push_back({periods, std::sqrt(spectrum_at(signal, periods / static_cast<double>(n)).value)});
  }
  for (auto& peak : peaks) peak.frequency /= static_cast<double>(n) * step;
  for (auto& peak : std::views::reverse(peaks)) peak.height /= peaks.front().height;
  return peaks;
}

double dominant_frequency(std::span<const double> times, std::span<const double> values)
{
  const auto peaks = spectral_peaks(times, values, 1);
  return peaks.empty() ? 0.0 : peaks[0].frequency;
}

Growth growth_rate(std::span<const double> times, std::span<const double> values, double frequency)
{
  check_samples(times, values);
  if (times.size() < 8 || !(frequency > 0.0)) return {};
  double mean = 0.0, square = 0.0;
  for (const double v : values) mean += v;
  mean /= static_cast<double>(values.size());
  for (const double v : values) square += (v - mean) * (v - mean);
  if (square <= 0.0) return {};

  const Fit fit(times, values, mean);
  const double length = fit.length();
  Growth best;
  // from the amplitude's growth; from none, should the first lead nowhere
  for (const double guess : {growth_guess(times, values, frequency), 0.0}) {
    Model model{guess * length, two_pi * frequency * length};
    fit.solve_linear(model);
    const double residual = std::sqrt(minimise(fit, model) / square);
    if (residual < best.relative_residual)
      best = {model.s / length, std::abs(model.omega) / (two_pi * length), residual};
    if (best.relative_residual < 0.1) break;
  }
  return best;
}

} // namespace mullion::run
