#include <mullion/app/results.hpp>

#include "io/run_record.hpp"
#include "report/csv_table.hpp"

#include <mullion/sdk/error.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <sys/resource.h>

namespace mullion {

double Results::value(const std::string& name) const
{
  for (const auto& quantity : quantities)
    if (quantity.name == name) return quantity.value;
  return std::numeric_limits<double>::quiet_NaN();
}

Results read_results(const std::string& folder)
{
  const std::filesystem::path path(folder);
  const auto record = io::read_run_record(path / "run.json");
  MULLION_REQUIRE(record && !record->attempts.empty(), Errc::io, "{} is no folder of a run: there is no run.json",
                  folder);
  const auto history = report::read_csv(path / "history.csv", report::LastLine::whole);
  MULLION_REQUIRE(history.n_rows > 0, Errc::io, "{}/history.csv has no rows", folder);
  const std::map<std::string, std::string> units(record->columns.begin(), record->columns.end());
  Results results;
  for (const auto& column : history.columns) {
    if (column.is_text()) continue;
    const auto unit = units.find(column.name);
    results.quantities.push_back({column.name, unit == units.end() ? "" : unit->second, column.numbers.back()});
  }
  for (const auto& timing : record->attempts.back().timings)
    results.calls.push_back({timing.who, timing.call, timing.count, timing.work_s});
  rusage usage{};
  ::getrusage(RUSAGE_CHILDREN, &usage);
  results.peak_megabytes = static_cast<double>(usage.ru_maxrss) / 1024.0;
  return results;
}

} // namespace mullion
