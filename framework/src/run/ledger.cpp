#include "run/ledger.hpp"

#include "run/session.hpp"

#include <cmath>

namespace mullion::run {

int ledger_size(const Ledger& ledger) { return static_cast<int>(4 * (1 + ledger.n_components)); }

std::vector<LedgerColumn> ledger_columns(const Ledger& ledger)
{
  std::vector<LedgerColumn> columns = {{"work_fluid", "J"}, {"work_structure", "J"}, {"work_defect", "J"}};
  for (const char* what : {"impulse_fluid", "impulse_structure", "impulse_defect"})
    for (std::uint32_t c = 0; c < ledger.n_components; ++c)
      columns.push_back({ledger.n_components == 1 ? what : fmt::format("{}_{}", what, "xyz"[c]), "N s"});
  return columns;
}

void count(Session& session, const Ledger& ledger, const TimeStep& step)
{
  const auto& control = session.control();
  const double fluid_end = control.working[ledger.fluid.window].stamp.time;
  const double fluid_begin = control.table(control.epoch.load()).windows[ledger.fluid.window].committed[0].time;
  const bool is_offset = std::abs(fluid_end - step.end) > 1e-9 * step.dt;
  const double ahead = is_offset ? (fluid_end - step.begin) / (fluid_end - fluid_begin) : 0.0;

  auto state = session.write(ledger.state);
  const auto n = static_cast<Eigen::Index>(ledger.n_components);
  const auto sums = 3 * (1 + n); // where the sums begin: work, then the impulses
  const auto put = [&](Eigen::Index fluid_at, Eigen::Index structure_at, Eigen::Index defect_at, Eigen::Index sum_at,
                       double fluid, double structure) {
    state(0, sum_at) += fluid - structure;
    state(0, fluid_at) += fluid;
    state(0, structure_at) += structure;
    state(0, defect_at) = is_offset ? state(0, sum_at) - ahead * fluid + structure : state(0, sum_at);
  };
  put(0, 1, 2, sums, session.read(ledger.fluid.work, 0)(0, 0), session.read(ledger.structure.work, 0)(0, 0));
  if (n == 0) return;
  const auto fluid = session.read(*ledger.fluid.impulse, 0), structure = session.read(*ledger.structure.impulse, 0);
  for (Eigen::Index c = 0; c < n; ++c) put(3 + c, 3 + n + c, 3 + 2 * n + c, sums + 1 + c, fluid(c, 0), structure(c, 0));
}

} // namespace mullion::run
