// Which columns of a history go into which plot: those of one section and unit together, as long as each of them can be
// seen: a column that would be a flat line beside another one gets a plot of its own.
#pragma once

#include "report/csv_table.hpp"

#include <map>
#include <string>
#include <vector>

namespace mullion::report {

/// Where in the report a column of history.csv belongs.
enum class Section { interface, outputs, energies, ledger, driver, residuals };

/// Columns of one plot.
struct CurveGroup {
  Section section = Section::interface;
  std::string unit;                      ///< "" if it is not known
  std::vector<const CsvColumn*> columns; ///< of numbers
};

/// Whether there is a finite number in the column.
[[nodiscard]] bool has_values(const CsvColumn& column);

/// The first finite number of the column, what energies are compared with; NaN if there is none.
[[nodiscard]] double first_value(const CsvColumn& column);

/// All columns with finite numbers but `step` and `time`, by section: "work_*", "impulse_*", "*residual" (".max" of it
/// too), "driver.*", unit J, the windows of the interface (those with a displacement, velocity, traction or load),
/// other outputs. On the interface these quantities come first, for the rest the order is that of the columns.
///
/// @param units  of columns, SI; those that are missing are taken as of one unknown unit a field name
[[nodiscard]] std::vector<CurveGroup> group_curves(const CsvTable& history,
                                                   const std::map<std::string, std::string>& units);

/// The field or quantity that a column belongs to: "velocity" of "structure.wet.velocity_x.max".
[[nodiscard]] std::string quantity_of(const std::string& column);

} // namespace mullion::report
