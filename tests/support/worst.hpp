// The largest error so far, for loops over results that may hold not-a-number: std::max would drop
// it silently.
#pragma once

namespace mullion::testing {

/// The larger of both; not-a-number as soon as either is.
inline double worst(double so_far, double error)
{
  return so_far != so_far || so_far >= error ? so_far : error;
}

} // namespace mullion::testing
