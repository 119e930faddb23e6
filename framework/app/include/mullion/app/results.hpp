// What a run left in its folder, for those who want a few numbers and not the files: the last values of its history and
// where its time went.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace mullion {

struct Quantity {
  std::string name, unit; ///< a column of history.csv
  double value = 0.0;     ///< in its last row
};

struct CallTime {
  std::string who, call;
  std::int64_t count = 0;
  double work_s = 0.0; ///< all calls together
};

struct Results {
  std::vector<Quantity> quantities;
  std::vector<CallTime> calls;
  double peak_megabytes = 0.0; ///< peak resident set of the largest process that this one started and that has ended

  /// The value of a quantity; NaN if there is none.
  [[nodiscard]] double value(const std::string& name) const;
};

/// @param folder  of a finished run
/// @throws Error Errc::io: no history.csv or no run.json, or not what a run writes
[[nodiscard]] Results read_results(const std::string& folder);

} // namespace mullion
