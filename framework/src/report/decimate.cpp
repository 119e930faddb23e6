#include "report/decimate.hpp"

#include <mullion/sdk/error.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mullion::report {
namespace {

/// The points of one bucket that show: first, smallest, largest, last, and the first that is not finite.
class Bucket {
public:
  void add(std::size_t index, double value)
  {
    if (!std::isfinite(value)) {
      if (!has_gap_) gap_ = index;
      has_gap_ = true;
      return;
    }
    if (!has_value_) {
      first_ = smallest_ = largest_ = index;
      low_ = high_ = value;
    }
    has_value_ = true;
    last_ = index;
    if (value < low_) low_ = value, smallest_ = index;
    if (value > high_) high_ = value, largest_ = index;
  }

  void move_to(std::vector<std::size_t>& chosen)
  {
    std::vector<std::size_t> own;
    if (has_value_) own = {first_, smallest_, largest_, last_};
    if (has_gap_) own.push_back(gap_);
    std::sort(own.begin(), own.end());
    chosen.insert(chosen.end(), own.begin(), std::unique(own.begin(), own.end()));
    *this = {};
  }

private:
  bool has_value_ = false, has_gap_ = false;
  std::size_t first_ = 0, smallest_ = 0, largest_ = 0, last_ = 0, gap_ = 0;
  double low_ = 0.0, high_ = 0.0;
};

} // namespace

std::vector<std::size_t> decimate(std::span<const double> x, std::span<const double> y, std::size_t n_buckets)
{
  MULLION_REQUIRE(x.size() == y.size(), Errc::shape, "decimate: {} values of x, {} of y", x.size(), y.size());
  std::vector<std::size_t> chosen;
  if (x.size() <= 5 * n_buckets) {
    chosen.resize(x.size());
    std::iota(chosen.begin(), chosen.end(), std::size_t{0});
    return chosen;
  }
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double width = (*high - *low) / static_cast<double>(n_buckets);
  const auto bucket_of = [&](double value) {
    return width > 0.0 ? std::min(std::floor((value - *low) / width), static_cast<double>(n_buckets - 1)) : 0.0;
  };
  Bucket bucket;
  double at = bucket_of(x[0]);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (const double here = bucket_of(x[i]); here != at) {
      bucket.move_to(chosen);
      at = here;
    }
    bucket.add(i, y[i]);
  }
  bucket.move_to(chosen);
  return chosen;
}

} // namespace mullion::report
