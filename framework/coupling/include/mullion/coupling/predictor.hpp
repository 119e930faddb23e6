// Predictors: what a quantity will be at the end of the step, from what is known at its begin. Expressions over the
// values, evaluated where they are used; constant steps give the well-known factors to the bit.
#pragma once

namespace mullion {

/// Velocity at t^{n+1} from the velocity at t^n and the accelerations at t^n and t^{n-1}, second order:
///
///     v_P = v^n + dt_n [(1 + r/2) a^n - (r/2) a^{n-1}],  r = dt_n / dt_{n-1}
///
/// which is v^n + dt (3/2 a^n - 1/2 a^{n-1}) for equal steps (Jaiman et al. 2011, Algorithm 2).
/// @param a0, a1  the factors for equal steps: 3/2 and 1/2, or others for a study
template <class V, class A>
auto predicted_velocity(const V& v, const A& a, const A& a_before, double dt, double ratio, double a0 = 1.5,
                        double a1 = 0.5)
{
  return v + dt * ((1.0 + (a0 - 1.0) * ratio) * a - (a1 * ratio) * a_before);
}

/// Linear extrapolation x^n + r (x^n - x^{n-1}), r = dt_n / dt_{n-1}.
template <class X> auto extrapolated_linearly(const X& now, const X& before, double ratio)
{
  return now + ratio * (now - before);
}

/// Quadratic extrapolation through the last three values, for equal steps: 3 x^n - 3 x^{n-1} + x^{n-2}.
template <class X> auto extrapolated_quadratically(const X& now, const X& before, const X& before_that)
{
  return 3.0 * (now - before) + before_that;
}

} // namespace mullion
