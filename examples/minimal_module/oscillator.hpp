// The kernel of spring_mass: a mass on a linear spring under a load, one step at a time. It knows neither windows
// nor case files, so a test can call it with three numbers.
#pragma once

namespace mullion::spring_mass {

/// A rigid mass on a spring. Displacement and load are positive along +x, away from the gas.
struct Oscillator {
  double mass = 100.0;      ///< M [kg]
  double stiffness = 4.0e6; ///< k [N/m]
};

struct Motion {
  double displacement = 0.0; ///< u, 0 where the spring is relaxed [m]
  double velocity = 0.0;     ///< v [m/s]
  double acceleration = 0.0; ///< a [m/s^2]
};

/// The acceleration in balance with a load: M a = F - k u.
inline double balance(const Oscillator& o, double displacement, double load)
{
  return (load - o.stiffness * displacement) / o.mass;
}

/// Newmark's average-acceleration step (beta = 1/4, gamma = 1/2) with the load at its end.
///
///     (M + dt^2/4 k) a' = F' - k (u + dt v + dt^2/4 a)                                Newmark 1959
///     u' = u + dt v + dt^2/4 (a + a'),  v' = v + dt/2 (a + a')
///
/// Second order, unconditionally stable, keeps the energy of a free mass.
/// @param load  F' [N]
/// @pre         M a = F - k u at the begin of the step
inline Motion newmark_step(const Oscillator& o, const Motion& m, double dt, double load)
{
  const double quarter = 0.25 * dt * dt;
  const double predicted = m.displacement + dt * m.velocity + quarter * m.acceleration;
  const double a = (load - o.stiffness * predicted) / (o.mass + quarter * o.stiffness);
  return {predicted + quarter * a, m.velocity + 0.5 * dt * (m.acceleration + a), a};
}

} // namespace mullion::spring_mass
