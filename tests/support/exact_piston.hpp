// Exact solutions of the linear piston (gas column against elastic bar, clamped far end): what the
// fluid, the bar and every coupling scheme are measured against. Independent of all solvers.
#pragma once

#include <vector>

namespace mullion::testing {

/// The piston of Jaiman et al. 2011, section 6: gas in [0, L_f], bar in [0, L_s] behind it, area 1
/// m^2.
///
/// Sign: displacement, velocity and load along +x, from the gas into the bar. The load step `dp` is
/// p_0 - p_ref, with which the bar starts undeformed.
struct Piston {
  double gamma = 1.4;
  double rho0 = 1.3;             ///< [kg/m^3]
  double p0 = 1.0e5;             ///< [Pa]
  double fluid_length = 1.0;     ///< L_f [m]
  double density_ratio = 2000.0; ///< mu = rho_s / rho_0
  double speed_ratio = 0.1;      ///< c_s / c_f
  int frequency_numerator = 1;   ///< f_r = f_s / f_f = numerator / denominator, in lowest terms
  int frequency_denominator = 2;
  double dp = 1.0e5; ///< load step [Pa]

  [[nodiscard]] double frequency_ratio() const
  {
    return static_cast<double>(frequency_numerator) / frequency_denominator;
  }
  [[nodiscard]] double fluid_speed() const; ///< c_f = sqrt(gamma p_0 / rho_0) [m/s]
  [[nodiscard]] double
  fluid_frequency() const; ///< f_f = c_f / (2 L_f), the unit of time is 1 / f_f [Hz]
  [[nodiscard]] double fluid_impedance() const; ///< z_f = rho_0 c_f [Pa s/m]
  [[nodiscard]] double solid_density() const;   ///< rho_s [kg/m^3]
  [[nodiscard]] double solid_speed() const;     ///< c_s [m/s]
  [[nodiscard]] double solid_impedance() const; ///< z_s = rho_s c_s [Pa s/m]
  [[nodiscard]] double youngs_modulus() const;  ///< E_s = rho_s c_s^2 [Pa]
  [[nodiscard]] double solid_length() const;    ///< L_s = (c_s / c_f) L_f / f_r [m]
  [[nodiscard]] double
  static_displacement() const; ///< dp / (E_s/L_s + rho_0 c_f^2/L_f) [m], closed piston
};

/// Lowest n angular frequencies of the closed piston [rad/s], ascending.
///
///     z_s cot(w L_s / c_s) + z_f cot(w L_f / c_f) = 0
///
/// (no net force on the massless interface). The left-hand side falls from +infinity to -infinity
/// between two neighbouring poles of either cotangent, so there is exactly one root in each such
/// interval; bisection to the last bit. A root in an empty interval (poles that coincide, as w = pi
/// c_f / L_f often does) has the interface at rest and is left out: no load on the interface
/// excites it.
[[nodiscard]] std::vector<double> closed_frequencies(const Piston& piston, int n);

/// Amplitude of a mode in the answer to the load step [m].
///
///     u_I(t) = dp / D(0) + sum_k A_k cos(w_k t),  A_k = 2 dp / (w_k D'(w_k)),  D(w) = w [z_s cot +
///     z_f cot]
///
/// by residues of the Laplace transform of u_I.
[[nodiscard]] double closed_amplitude(const Piston& piston, double frequency);

/// u_I(t) of the closed piston by the modal sum over the given frequencies [m]. The tail decays
/// like 1 / w_k^2.
[[nodiscard]] double closed_displacement(const Piston& piston,
                                         const std::vector<double>& frequencies, double time);

/// Growth rate of a closed mode if the load lags the motion by tau in all, to first order in tau
/// [1/s].
///
///     sigma = w tau z_f cot(w L_f/c_f) / (z_s (L_s/c_s) / sin^2(w L_s/c_s) + z_f (L_f/c_f) /
///     sin^2(w L_f/c_f))
///
/// From replacing z_f cot by z_f cot exp(-i w tau) in the frequency equation. Positive: the mode
/// grows.
[[nodiscard]] double lag_growth_rate(const Piston& piston, double frequency, double tau);

/// Interface values at one instant.
struct InterfaceState {
  double displacement; ///< u_I [m]
  double velocity;     ///< v_I, just after the instant [m/s]
  double pressure;     ///< p' = p - p_0, just after the instant [Pa]
};

enum class TubeEnd { closed, open };

/// Answer to the load step by characteristics, exact at all times up to `duration`.
///
///     p' = f + g, v = (f - g) / z_f in the gas, s = r + l, v = (r - l) / z_s in the bar, at the
///     interface v = (dp + 2 f - 2 l) / (z_s + z_f),  g = f - z_f v,  r = l + z_s v f(t) = g(t - 2
///     L_f / c_f) (closed) or 0 (open),  l(t) = r(t - 2 L_s / c_s) (clamped)
///
/// All are constant between ticks of length T_f / numerator(f_r), to which both delays are
/// commensurate.
class CharacteristicsSolution {
public:
  /// @param duration  last time that will be asked for [s]
  CharacteristicsSolution(const Piston& piston, TubeEnd tube_end, double duration);

  /// @pre  0 <= time <= duration
  [[nodiscard]] InterfaceState at(double time) const;

private:
  double tick_;
  std::vector<double> velocity_, pressure_, displacement_; // per tick; displacement at its begin
};

/// Decay rate of the open piston's square wave, envelope (R)^n with R = (z_s - z_f)/(z_s + z_f) per
/// 2 L_s / c_s: -f_r ln((z_s + z_f) / (z_s - z_f)) per unit of f_f t.
[[nodiscard]] double open_decay_rate(const Piston& piston);

} // namespace mullion::testing
