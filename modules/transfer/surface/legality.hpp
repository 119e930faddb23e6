// Which field may be transferred to which: a traction where loads are expected is wrong by an area, and nobody would
// see it in the numbers.
#pragma once

#include <string>

namespace mullion::surface {

enum class Quantity { traction, load, velocity, displacement };

/// Per point of the surface, or summed over a part of it.
enum class Nature { intensive, extensive };

/// A field at one end of a transfer.
struct Transferred {
  Quantity quantity;
  Nature nature;
};

/// Why this transfer is not possible, and what would be; "" if it is.
///
///     source \ target   traction             load            velocity, displacement
///     traction          with recovery        load operator   no
///     load              with recovery        load to load    no
///     velocity, disp.   no                   no              the same quantity, motion operator
///
/// A traction, velocity or displacement is intensive, a load extensive; anything else is refused.
///
/// @param has_recovery  nodal traction is recovered from loads, with a mass matrix
[[nodiscard]] std::string complaint_about_transfer(const Transferred& source, const Transferred& target,
                                                   bool has_recovery);

} // namespace mullion::surface
