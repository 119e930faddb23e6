// Which fields of a run are drawn as pictures, and how: by a rule on locations, units and shapes alone, for the
// framework knows no module. docs/how_to/read_report.md tells the rule to the reader.
#pragma once

#include "report/page.hpp"

#include <filesystem>

namespace mullion::report {

/// A section with the fields of each plane window (see plane_mesh.hpp) at the last output, where the mesh then lies.
/// Nothing is added where a run has no results or no such window.
/// @throws Error Errc::io: a file of the results is damaged
void add_field_pictures(Page& page, const std::filesystem::path& folder);

/// By how much a displacement is magnified: 1, 2 or 5 times a power of ten, such that the largest becomes a tenth of
/// the extent at most, and more than 4 % of it.
/// @param largest  [m], > 0
/// @param extent   of the mesh [m], > 0
[[nodiscard]] double magnification(double largest, double extent);

} // namespace mullion::report
