#include "run/interface_report.hpp"

#include "run/signal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mullion::run {
namespace {

constexpr double n_periods = 20.0;       // of the window in which growth and defect are compared
constexpr std::size_t least_steps = 200; // in it
constexpr double least_growth = 0.02;    // over it
constexpr double agreement = 2.0;        // factor between the fitted rate and the explained one

struct Oscillation {
  std::vector<double> times, values;
};

/// The component with the largest variance.
Oscillation main_component(std::span<const InterfaceSeries::Sample> samples)
{
  Oscillation best;
  double largest = 0.0;
  for (int c = 0; c < InterfaceSeries::n_velocities; ++c) {
    double mean = 0.0, square = 0.0;
    for (const auto& sample : samples) mean += sample.velocity[c];
    mean /= static_cast<double>(samples.size());
    for (const auto& sample : samples) square += (sample.velocity[c] - mean) * (sample.velocity[c] - mean);
    if (!(square > largest)) continue;
    largest = square;
    best.values.clear();
    for (const auto& sample : samples) best.values.push_back(sample.velocity[c]);
  }
  if (best.values.empty()) return best;
  for (const auto& sample : samples) best.times.push_back(sample.time);
  return best;
}

} // namespace

void InterfaceSeries::add(const Sample& sample)
{
  if (!samples_.empty() && ++skipped_ < stride_) return;
  skipped_ = 0;
  samples_.push_back(sample);
  if (samples_.size() < capacity) return;
  for (std::size_t i = 0; i < capacity / 2; ++i) samples_[i] = samples_[2 * i];
  samples_.resize(capacity / 2);
  skipped_ = stride_; // the newest one went
  stride_ *= 2;
}

InterfaceMotion fit_motion(std::span<const InterfaceSeries::Sample> samples)
{
  const auto [times, values] = main_component(samples);
  if (values.size() < 8) return {};
  InterfaceMotion motion;
  motion.frequency = dominant_frequency(times, values);
  if (motion.frequency == 0.0) return motion;
  const auto fit = growth_rate(times, values, motion.frequency);
  motion.growth = fit.sigma;
  motion.relative_residual = fit.relative_residual;
  if (fit.frequency > 0.0) motion.frequency = fit.frequency;
  return motion;
}

std::optional<ManufacturedEnergy> find_manufactured_energy(const InterfaceSeries& series)
{
  const auto all = series.samples();
  const double frequency = fit_motion(all).frequency;
  if (frequency == 0.0 || all.size() < 2) return std::nullopt;
  const double sample_time = all[1].time - all[0].time;
  const auto stride = static_cast<std::size_t>(series.stride());
  const auto wanted = std::max(static_cast<std::size_t>(std::ceil(n_periods / (frequency * sample_time))),
                               (least_steps + stride - 1) / stride);
  if (wanted + 1 > all.size()) return std::nullopt;
  const auto window = all.last(wanted + 1);

  const double growth = fit_motion(window).growth;
  const double duration = window.back().time - window.front().time;
  if (std::expm1(growth * duration) < least_growth) return std::nullopt;

  double n = 0, sum_t = 0, sum_d = 0, sum_tt = 0, sum_td = 0, energy = 0;
  for (const auto& sample : window) {
    const double t = sample.time - window.front().time;
    n += 1, sum_t += t, sum_d += sample.defect, sum_tt += t * t, sum_td += t * sample.defect;
    energy += sample.structure_energy;
  }
  const double made = -(n * sum_td - sum_t * sum_d) / (n * sum_tt - sum_t * sum_t); // power out of nowhere [W]
  energy /= n;
  if (!(made > 0.0) || !(energy > 0.0)) return std::nullopt;
  const double explained = made / (2.0 * energy);
  if (explained > agreement * growth || explained < growth / agreement) return std::nullopt;
  return ManufacturedEnergy{growth, explained, frequency};
}

double growth_from_lag(double lag, double coupled_frequency, double vacuum_frequency)
{
  constexpr double two_pi = 2.0 * std::numbers::pi;
  return two_pi * coupled_frequency * lag * two_pi * (coupled_frequency - vacuum_frequency);
}

} // namespace mullion::run
