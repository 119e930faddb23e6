// What a run says about its interface: how much work crossed it, how much of it the scheme lost or made, how fast the
// interface's oscillation grows, and how fast the scheme's net lag alone would make it grow.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace mullion::run {

/// The interface's history, thinned out so that it never grows: when it is full, every other sample goes and from
/// then on half as many come.
class InterfaceSeries {
public:
  static constexpr std::size_t capacity = 65536; ///< samples; even
  static constexpr int n_velocities = 3;

  struct Sample {
    double time = 0.0;                  ///< [s]
    double velocity[n_velocities] = {}; ///< of the structure's wet surface, mean over its nodes [m/s]
    double defect = 0.0;                ///< work_defect so far [J]
    double structure_energy = 0.0;      ///< kinetic and elastic [J]; 0 if the structure doesn't tell
  };
  void add(const Sample& sample);

  [[nodiscard]] std::span<const Sample> samples() const { return samples_; }
  [[nodiscard]] int stride() const { return stride_; } ///< steps from sample to sample

private:
  std::vector<Sample> samples_;
  int stride_ = 1;
  int skipped_ = 0; ///< steps since the last kept one
};

/// The oscillation of the interface, fitted to the component of the velocity that moves most.
struct InterfaceMotion {
  double frequency = 0.0;         ///< [Hz]; 0: nothing oscillates
  double growth = 0.0;            ///< [1/s]
  double relative_residual = 1.0; ///< of the fit; near 0 if one mode dominates
};
[[nodiscard]] InterfaceMotion fit_motion(std::span<const InterfaceSeries::Sample> samples);

/// Does the scheme manufacture energy? Yes if, over the last 20 periods of the dominant frequency (and at least 200
/// steps), both the velocity grew by 2 % or more and the defect's slope explains it: the power that came from nowhere,
/// over twice the structure's mean energy, is within a factor of 2 of the fitted rate.
struct ManufacturedEnergy {
  double growth;    ///< [1/s], fitted
  double explained; ///< [1/s], power / (2 E)
  double frequency; ///< [Hz]
};
[[nodiscard]] std::optional<ManufacturedEnergy> find_manufactured_energy(const InterfaceSeries& series);

/// Growth that a net lag makes, from the shift that the fluid gives the structure's frequency [1/s]:
///
///     sigma = omega tau 2 pi (f_coupled - f_vacuum)
///
/// A fluid that acts as a spring raises the frequency; a late spring force feeds the motion. To first order in tau and
/// in the shift.
[[nodiscard]] double growth_from_lag(double lag, double coupled_frequency, double vacuum_frequency);

} // namespace mullion::run
