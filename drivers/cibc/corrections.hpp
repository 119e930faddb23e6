// The corrections of CIBC as formulas over arrays, one value a wall point, everything along n_f, out of the fluid.
//
// The fluid at a wall that moves with it obeys rho_f Dv/Dt = -dp/dn; velocity and traction are continuous, and so are
// their rates. A combination of the two rates with the weight omega [s/m], chosen so that excess pressure of the fluid
// pushes the wall away, corrects the velocity and the traction (Jaiman et al. 2011, equations 12 to 19):
//
//     rho_f dv/dt = -dp/dn + omega (P_t - P_s,t)            the velocity that the fluid gets
//     P_s,t       = P_t - r / omega,  r = dp/dn + rho_f a_s  the traction that the structure gets
//
// With these signs both are damping; the printed text has lost minus signs, and the opposite sign grows.
#pragma once

#include <Eigen/Core>

namespace mullion::cibc {

using Values = Eigen::Array<double, 1, Eigen::Dynamic>;

/// Velocity increment of a step [m/s].
/// @param gradient        dp/dn [Pa/m]
/// @param fluid_rate      P_t [Pa/s], of the traction that the fluid exports
/// @param applied_rate    P_s,t [Pa/s], of the traction that was applied to the structure
inline Values velocity_increment(double dt, double density, double omega, const Values& gradient,
                                 const Values& fluid_rate, const Values& applied_rate)
{
  return dt / density * (-gradient + omega * (fluid_rate - applied_rate));
}

/// r = dp/dn + rho_f a_s [Pa/m]: by how much the wall's fluid and the structure disagree about the acceleration.
inline Values acceleration_residual(double density, const Values& gradient, const Values& acceleration)
{
  return gradient + density * acceleration;
}

/// The admissible weights, as kappa = omega c with C_D = c Dt / dx_n; outside, grid-scale modes grow (measured, and
/// derived for the upper bound of the consistent reading).
struct Window {
  double lower = 0.0, upper = 0.0; ///< of kappa; outside: an error
  double largest_courant = 0.0;    ///< of C_D; above: an error
  double advisable = 0.0;          ///< of kappa; below: a warning (gain dt / (omega dx_n) above 1)
};

} // namespace mullion::cibc
