// The numerical flux between two cells whose common face moves: HLLC in the laboratory frame, with
// the wave fan sampled at the face's own speed.
#pragma once

#include "gas.hpp"

namespace mullion::euler_1d {

/// HLLC flux through a face that moves with velocity w.
///
///     F(U*) - w U*,  U* = the state of the three-wave fan (S_L, S_*, S_R) on the ray x/t = w
///     S_L = min(u_L - c_L, u~ - c~),  S_R = max(u_R + c_R, u~ + c~)          (~: Roe mean)
///     S_* = (p_R - p_L + rho_L u_L (S_L - u_L) - rho_R u_R (S_R - u_R)) / (rho_L (S_L - u_L) -
///     rho_R (S_R - u_R)) rho_K* = rho_K (S_K - u_K) / (S_K - S_*),  p* = p_K + rho_K (S_K -
///     u_K)(S_* - u_K)
///
/// Toro 2009, section 10.4; wave speeds of Batten et al. 1997. For equal states it
/// is the physical flux F(U) - w U, and a contact that moves with the face lets no mass through.
///
/// @param left, right  states on the two sides of the face
/// @param w            velocity of the face along +x [m/s]
/// @return             flux along +x relative to the face
/// @pre                positive density and pressure on both sides (else the result is not finite)
[[nodiscard]] Flux hllc_flux(const Gas& gas, const Primitive& left, const Primitive& right, double w);

} // namespace mullion::euler_1d
