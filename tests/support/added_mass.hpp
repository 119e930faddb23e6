// The added-mass model problem of Causin, Gerbeau, Nobile 2005, solved as one linear system: what every coupling
// scheme on added_mass_fluid and string_1d is measured against. Independent of the two plug-ins and their kernels.
#pragma once

#include <array>
#include <vector>

namespace mullion::testing {

/// A potential flow in [0, L] x [0, R] below a string, from rest, pushed by a pulse; equations in the plug-ins.
///
/// Sign: displacement and pressure are positive out of the fluid.
struct AddedMassProblem {
  int n_points = 100;            ///< x_i = i L / (n_points + 1), i = 1 … n_points
  double length = 6.0;           ///< L [m]
  double radius = 0.5;           ///< R [m]
  double thickness = 0.1;        ///< h [m]
  double solid_density = 1.1;    ///< rho_s [kg/m^3]
  double stiffness = 4.0e5;      ///< a [Pa/m]
  double tension = 2.5e4;        ///< b [Pa m]
  double fluid_density = 1.0;    ///< rho_f [kg/m^3]
  double pulse_pressure = 2.0e4; ///< p_0 of p_e = p_0 exp(-4 (x - 1.5)^2), while t^n < pulse_end [Pa]
  double pulse_end = 5.0e-3;     ///< [s]
  double dt = 1.0e-4;            ///< [s]
  int n_steps = 50;
};

/// One density of the wall, with results of a separate tool for the problem above.
struct AddedMassCase {
  double solid_density; ///< rho_s [kg/m^3]
  double mass_ratio;    ///< rho_f mu_1 / (rho_s h): added mass over mass of the wall
  double norm;          ///< root of the sum of eta_i^2 after 50 steps, fully coupled [m]
  double iterations;    ///< mean over the steps, of serial fixed-point iterations with Aitken's relaxation:
                        ///< first factor 0.5 in each step, guess eta^n, changes of eta and p below 1e-6 relative
};
inline constexpr std::array added_mass_cases = {
    AddedMassCase{750.0, 0.0995, 1.0546669e-2, 7.92},
    AddedMassCase{75.0, 0.995, 7.7625746e-2, 11.6},
    AddedMassCase{10.0, 7.46, 1.8456235e-1, 20.9},
    AddedMassCase{1.1, 67.8, 1.8804147e-1, 40.6},
};

/// Displacement [m] of the points after 0, 1, … n_steps steps, with the fluid's pressure eliminated.
///
///     ((rho_s h I + rho_f M_A) / dt^2 + a I - b D_2) eta^{n+1} = p_e + (rho_s h I + rho_f M_A) (2 eta^n - eta^{n-1}) /
///     dt^2
[[nodiscard]] std::vector<std::vector<double>> monolithic_history(const AddedMassProblem& problem);

/// Root of the sum of squares over the points [m], after 0, 1, … 50 steps; all but the wall's density [kg/m^3] as
/// above.
[[nodiscard]] std::vector<double> monolithic_norms(double solid_density);

} // namespace mullion::testing
