// Frequencies, modal sums and characteristics of the linear piston.
#include "exact_piston.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace mullion::testing {

namespace {

constexpr double pi = std::numbers::pi;

double cot(double x) { return std::cos(x) / std::sin(x); }

double per_sine_squared(double x)
{
  const double s = std::sin(x);
  return 1.0 / (s * s);
}

// z_s (L_s/c_s) / sin^2 + z_f (L_f/c_f) / sin^2 = -d/dw of the frequency equation's left-hand side
double steepness(const Piston& p, double w)
{
  const double t_s = p.solid_length() / p.solid_speed();
  const double t_f = p.fluid_length / p.fluid_speed();
  return p.solid_impedance() * t_s * per_sine_squared(w * t_s) +
         p.fluid_impedance() * t_f * per_sine_squared(w * t_f);
}

} // namespace

double Piston::fluid_speed() const { return std::sqrt(gamma * p0 / rho0); }
double Piston::fluid_frequency() const { return fluid_speed() / (2.0 * fluid_length); }
double Piston::fluid_impedance() const { return rho0 * fluid_speed(); }
double Piston::solid_density() const { return density_ratio * rho0; }
double Piston::solid_speed() const { return speed_ratio * fluid_speed(); }
double Piston::solid_impedance() const { return solid_density() * solid_speed(); }
double Piston::youngs_modulus() const { return solid_density() * solid_speed() * solid_speed(); }
double Piston::solid_length() const { return speed_ratio * fluid_length / frequency_ratio(); }
double Piston::static_displacement() const
{
  return dp / (youngs_modulus() / solid_length() + gamma * p0 / fluid_length);
}

std::vector<double> closed_frequencies(const Piston& piston, int n)
{
  const double t_s = piston.solid_length() / piston.solid_speed();
  const double t_f = piston.fluid_length / piston.fluid_speed();
  const auto imbalance = [&](double w) {
    return piston.solid_impedance() * cot(w * t_s) + piston.fluid_impedance() * cot(w * t_f);
  };

  std::vector<double> poles{0.0};
  for (int k = 1; k <= n + 1; ++k) {
    poles.push_back(k * pi / t_s);
    poles.push_back(k * pi / t_f);
  }
  std::sort(poles.begin(), poles.end());

  std::vector<double> frequencies;
  for (std::size_t i = 0; i + 1 < poles.size() && std::ssize(frequencies) < n; ++i) {
    double low = poles[i];
    double high = poles[i + 1];
    if (high - low < 1e-9 * (pi / t_f)) // the same pole twice, up to round-off
      continue;
    for (int halving = 0; halving < 200; ++halving) {
      const double middle = 0.5 * (low + high);
      if (middle <= low || middle >= high)
        break;
      (imbalance(middle) > 0.0 ? low : high) = middle;
    }
    frequencies.push_back(0.5 * (low + high));
  }
  return frequencies;
}

double closed_amplitude(const Piston& piston, double frequency)
{
  const double slope = -frequency * steepness(piston, frequency); // D'(w_k)
  return 2.0 * piston.dp / (frequency * slope);
}

double closed_displacement(const Piston& piston, const std::vector<double>& frequencies,
                           double time)
{
  double sum = piston.static_displacement();
  for (const double w : frequencies)
    sum += closed_amplitude(piston, w) * std::cos(w * time);
  return sum;
}

double lag_growth_rate(const Piston& piston, double frequency, double tau)
{
  const double t_f = piston.fluid_length / piston.fluid_speed();
  return frequency * tau * piston.fluid_impedance() * cot(frequency * t_f) /
         steepness(piston, frequency);
}

CharacteristicsSolution::CharacteristicsSolution(const Piston& piston, TubeEnd tube_end,
                                                 double duration)
{
  // T_f = numerator ticks and T_s = T_f / f_r = denominator ticks.
  const auto fluid_delay = static_cast<std::size_t>(piston.frequency_numerator);
  const auto solid_delay = static_cast<std::size_t>(piston.frequency_denominator);
  const double z_f = piston.fluid_impedance();
  const double z_s = piston.solid_impedance();
  tick_ = 2.0 * piston.fluid_length / piston.fluid_speed() / piston.frequency_numerator;

  const auto n = static_cast<std::size_t>(duration / tick_) + 2;
  std::vector<double> g(n), r(n);
  double displacement = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double f = tube_end == TubeEnd::closed && i >= fluid_delay ? g[i - fluid_delay] : 0.0;
    const double l = i >= solid_delay ? r[i - solid_delay] : 0.0;
    const double v = (piston.dp + 2.0 * f - 2.0 * l) / (z_s + z_f);
    g[i] = f - z_f * v;
    r[i] = l + z_s * v;
    velocity_.push_back(v);
    pressure_.push_back(f + g[i]);
    displacement_.push_back(displacement);
    displacement += v * tick_;
  }
}

InterfaceState CharacteristicsSolution::at(double time) const
{
  const auto i = std::min(static_cast<std::size_t>(time / tick_), velocity_.size() - 1);
  const double since = time - static_cast<double>(i) * tick_;
  return {displacement_[i] + velocity_[i] * since, velocity_[i], pressure_[i]};
}

double open_decay_rate(const Piston& piston)
{
  const double z_f = piston.fluid_impedance();
  const double z_s = piston.solid_impedance();
  return -piston.frequency_ratio() * std::log((z_s + z_f) / (z_s - z_f));
}

} // namespace mullion::testing
