// The interface ledger: the work and the momentum that crossed the interface so far, as either side counted them in
// each coupling step, and the accumulated difference. It stands in driver/state, so it survives what the run survives.
//
// What the fluid lost at its wall and what the structure got would be the same if the coupling were exact; the defect
// sum(W_f - W_s) is positive when energy is lost at the interface, negative when the interface makes some. It is a
// monitor: it holds in-phase (harmless) parts too, and is no growth rate (see interface_report.hpp).
#pragma once

#include "run/field_address.hpp"

#include <mullion/sdk/window.hpp>

#include <optional>
#include <string>
#include <vector>

namespace mullion::run {

class Session;

/// One side: the pane outputs `work` [J] and, where there is one, `impulse` [N s] of an interface window, both of the
/// last step, positive when the fluid works on the structure.
struct LedgerSide {
  std::uint32_t window = 0;
  FieldAddress work{};
  std::optional<FieldAddress> impulse;
};

struct Ledger {
  LedgerSide fluid, structure;
  FieldAddress state{};           ///< in driver/state
  std::uint32_t n_components = 0; ///< of the impulses; 0: not counted
};

inline constexpr const char* ledger_field = "ledger"; ///< its name in driver/state

/// Numbers that the ledger keeps.
[[nodiscard]] int ledger_size(const Ledger& ledger);

/// Names and units of the numbers that history.csv shows; they come first in the field:
/// work_fluid, work_structure, work_defect, and the same for the impulses, all since the start. (The modules' own
/// columns have each step's.)
struct LedgerColumn {
  std::string name, unit;
};
[[nodiscard]] std::vector<LedgerColumn> ledger_columns(const Ledger& ledger);

/// Count the step that the driver just did. Where the fluid's clock is offset (half-step schemes), its last step
/// covers [a, b] around the step's begin t; the sums are compared at t: without the share (b - t)/(b - a) of that
/// step's work and without the structure's step, which begins at t.
void count(Session& session, const Ledger& ledger, const TimeStep& step);

} // namespace mullion::run
