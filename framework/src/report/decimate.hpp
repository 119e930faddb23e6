// Long histories, thinned out for plotting such that a plot of the chosen points looks like one of all of them: a
// picture has no more columns than pixels, and within one of them only the first, smallest, largest and last value
// show.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace mullion::report {

/// The points to draw, in order: of each of `n_buckets` equal intervals of x the first, the last, the smallest and the
/// largest y, so every spike survives. Of values that are not finite one a bucket is kept: it interrupts the curve.
///
/// @param x   finite; where it goes back, a new bucket begins
/// @param y   as many
/// @return    indices, increasing, at most 5 a bucket where x increases; all of them if there are no more than that
[[nodiscard]] std::vector<std::size_t> decimate(std::span<const double> x, std::span<const double> y,
                                                std::size_t n_buckets);

} // namespace mullion::report
