// What a vibrating wall loses to the gas in a duct with open ends: the load of the linearised gas on a mode of the
// wall, and the growth and the shift of the frequency that it makes. No windows: the
// wall is a list of straight pieces.
//
// The wall is part of the floor y = 0 of a straight duct of height H without ends, in which gas flows along x. It
// displaces the gas by w(x) q(t) along y, phi^T M phi = 1. From the linearised equations of a
// uniform flow (waves in ducts: [`rienstra2004`], chapter 7)
//
//     q'' + omega_s^2 q = -K(omega_s) q,    to first order in the gas: omega = omega_s + K/(2 omega_s), sigma = Im
//     omega K(omega) = b/(2 pi) int rho (omega - U k)^2 cot(alpha H)/alpha |w^(k)|^2 dk, alpha^2 = (omega - U k)^2/c^2
//     - k^2,    w^(k) = int w(x) exp(-i k x) dx,    omega -> omega + i 0,    ~ exp(-i omega t)
//
// The poles on the real axis are the waves that travel along the duct, two for each number n of nodes across it with
// omega/c > sqrt(1 - M^2) n pi/H; what they carry away is the imaginary part of K. Curvature of the wall and what its
// height does to the flow are left out.
#pragma once

#include "boundary.hpp"

#include <complex>
#include <vector>

namespace mullion::elastic_solid {

/// Gas in a duct.
struct Duct {
  double height = 0.0;      ///< H > 0 [m]
  double speed = 0.0;       ///< U along x, |U| < sound_speed [m/s]
  double density = 0.0;     ///< rho > 0 [kg/m^3]
  double sound_speed = 0.0; ///< c > 0 [m/s]
};

/// A piece of the wall in which w is linear; w is 0 outside of all pieces.
struct WallPiece {
  double x_begin = 0.0, x_end = 0.0; ///< x_begin < x_end [m]
  double w_begin = 0.0, w_end = 0.0; ///< displacement along y of a mode of mass 1 [1/sqrt(kg)]
};

/// A surface of the plane that moves by a mode, seen from the gas above: at a fixed x it moves along y by
/// w = u_x n_x/n_y + u_y, linear between the nodes.
/// @param nodes  (2 x n_nodes) of the surface [m]
/// @param shape  (2 x n_nodes) the mode [1/sqrt(kg)]
/// @return       empty if the surface is upright somewhere
[[nodiscard]] std::vector<WallPiece> wall_of(const Eigen::MatrixXd& nodes, const Surface& surface,
                                             const Eigen::MatrixXd& shape);

/// w^(k) = int w exp(-i k x) dx, exact for the pieces, for complex k too [m/sqrt(kg)].
[[nodiscard]] std::complex<double> wall_transform(const std::vector<WallPiece>& wall, std::complex<double> k);

/// K(omega) by quadrature along a path that passes the poles as omega + i 0 does. No value for omega at a cut-on
/// frequency, where K is infinite.
/// @param depth  b of the slice that the mode's mass is of [m]
/// @param omega  > 0 [rad/s]
/// @return       [1/s^2]
[[nodiscard]] std::complex<double> duct_load(const std::vector<WallPiece>& wall, double depth, double omega,
                                             const Duct& duct);

/// What the duct's gas makes of a mode.
struct Radiation {
  double growth = 0.0; ///< sigma of exp(sigma t) [1/s]: negative, the waves take energy along
  double shift = 0.0;  ///< of the frequency [Hz]: negative where the load is like a mass
};

/// First order in the gas' density: good while |growth| and |shift| are small beside the frequency, and the frequency
/// is not that of a cut-on.
[[nodiscard]] Radiation duct_radiation(const std::vector<WallPiece>& wall, double depth, double omega,
                                       const Duct& duct);

} // namespace mullion::elastic_solid
