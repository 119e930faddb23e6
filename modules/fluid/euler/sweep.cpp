// The sweep over the mesh, where the time goes: fluxes and update. Faces and cells are taken several at a time: what
// belongs to one stands together in memory, is loaded as a row, and rows of several are turned into vectors. What few
// faces need, boundaries and states that are no gas, is done apart, so that the loops have no branches.
#include "groups.hpp"
#include "widths.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

/// Groups of faces that each part of the flux is computed for before the next part.
constexpr std::size_t groups_together = 8;

/// What the states at faces are made from.
template <int D> struct FaceArrays {
  const Values<D>* values;
  const Gradient<D>* gradients;
  const FacePlane<D>* planes;
  const FaceOffsets<D>* offsets;
  const Index* owner;
  const Index* neighbour;
};

/// The cells on one side of faces; any where there is none.
template <int N> MULLION_INLINE std::array<Index, N> cells_beside(const Index* side, const Numbers<N>& faces)
{
  std::array<Index, N> cells;
  for (std::size_t i = 0; i < N; ++i) cells[i] = std::max<Index>(side[faces[i]], 0);
  return cells;
}

/// Values of one side at the faces, the cells' own where the gradient leads to what is no gas.
template <int D, int N, bool is_second>
MULLION_INLINE std::array<Lanes<N>, n_values<D>> side_of(const FaceArrays<D>& in, const Numbers<N>& faces,
                                                         const Index* cells, std::size_t side)
{
  std::array<Row<D>, N> rows;
  for (std::size_t i = 0; i < N; ++i) {
    const auto c = static_cast<std::size_t>(cells[i]);
    rows[i] = row_of<D>(in.values[c]);
    if constexpr (is_second) rows[i] = value_at<D>(rows[i], in.gradients[c], in.offsets[faces[i]][side]);
  }
  auto state = turned<n_values<D>, Row<D>, N>(rows);
  if constexpr (is_second) {
    const auto least = if_positive(state[0], state[D + 1]);
    if (!all_positive(least)) [[unlikely]] {
      for (std::size_t i = 0; i < N; ++i) rows[i] = row_of<D>(in.values[cells[i]]);
      const auto plain = turned<n_values<D>, Row<D>, N>(rows);
      for (std::size_t v = 0; v < n_values<D>; ++v) state[v] = least > 0.0 ? state[v] : plain[v];
    }
  }
  return state;
}

/// States and planes of faces between the cells left[i] and right[i].
template <int D, int N, bool is_second>
MULLION_INLINE FaceStates<D, Lanes<N>> states_at(const FaceArrays<D>& in, const Numbers<N>& faces, const Index* left,
                                                 const Index* right)
{
  std::array<Row<D>, N> planes;
  for (std::size_t i = 0; i < N; ++i) planes[i] = plane_row<D>(in.planes[faces[i]]);
  FaceStates<D, Lanes<N>> states;
  const auto plane = turned<D + 2, Row<D>, N>(planes);
  for (std::size_t d = 0; d < D; ++d) states.normal[d] = plane[d];
  states.area = plane[D];
  states.speed = plane[D + 1];
  states.left = side_of<D, N, is_second>(in, faces, left, 0);
  states.right = side_of<D, N, is_second>(in, faces, right, 1);
  return states;
}

} // namespace

template <int D>
template <std::size_t N>
void Solver<D>::set_beside(std::size_t b, std::size_t i, FaceStates<D, Lanes<N>>& states) const
{
  const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
  if (!is_upwinded(condition.kind)) return; // its flux is replaced
  const auto& beside = condition.kind == Kind::far_field ? condition.state : prescribed_[b];
  for (std::size_t v = 0; v < n_values<D>; ++v) states.right[v][i] = beside[v];
}

template <int D>
template <std::size_t N>
void Solver<D>::set_flux(std::size_t b, std::size_t i, const FaceStates<D, Lanes<N>>& states, Values<D>& flux)
{
  const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
  if (is_upwinded(condition.kind)) return;
  const auto& plane = geometry_.planes[static_cast<std::size_t>(mesh_.boundary[b].face)];
  Values<D> w;
  for (std::size_t v = 0; v < w.size(); ++v) w[v] = states.left[v][i];
  if (condition.kind == Kind::wall)
    stage_pressure_[b] = wall_pressure<D>(scheme_.gas, w, along<D>(w, plane.normal.data()) - plane.speed);
  flux = boundary_flux<D>(scheme_.gas, condition, w, plane.normal.data(), plane.speed);
  for (auto& value : flux) value *= plane.area;
}

template <int D> template <int N, bool is_second, Flux flux> MULLION_INLINE void Solver<D>::sweep_halo(Part& part) const
{
  const FaceArrays<D> in{values_.data(),           gradients_.data(),  geometry_.planes.data(),
                         geometry_.offsets.data(), mesh_.owner.data(), mesh_.neighbour.data()};
  const std::size_t mask = part.residuals.size() - 1;
  for_groups<N>(
      0, part.halo.size(), [&](const Numbers<N>& at) __attribute__((always_inline)) {
        Numbers<N> faces;
        for (std::size_t i = 0; i < N; ++i) faces[i] = static_cast<std::size_t>(part.halo[at[i]]);
        const auto left = cells_beside<N>(in.owner, faces), right = cells_beside<N>(in.neighbour, faces);
        const auto states = states_at<D, N, is_second>(in, faces, left.data(), right.data());
        const auto rows = turned_back<D, N>(flux == Flux::hllc ? hllc_flux<D, Lanes<N>>(scheme_.gas, states)
                                                               : roe_flux<D, Lanes<N>>(scheme_.gas, states));
        for (std::size_t i = 0; i < N && at[i] == at[0] + i; ++i) {
          auto& residual = part.residuals[static_cast<std::size_t>(right[i]) & mask];
          put_row<D>(row_of<D>(residual) - rows[i], residual);
          const auto& plane = in.planes[faces[i]];
          part.swept[static_cast<std::size_t>(right[i]) & mask] -= plane.speed * plane.area;
        }
      });
}

// Each loop does one thing for several groups, so that a group's chain of roots and quotients, or its wait for memory,
// goes on beside those of others: as far as the processor looks ahead, there are not two groups' whole fluxes.
template <int D>
template <int N, bool is_second, Flux flux>
MULLION_INLINE void Solver<D>::find_fluxes(Part& part, std::size_t begin, std::size_t end, std::size_t& b)
{
  using Pack = Lanes<N>;
  const FaceArrays<D> in{values_.data(),           gradients_.data(),  geometry_.planes.data(),
                         geometry_.offsets.data(), mesh_.owner.data(), mesh_.neighbour.data()};
  const Gas gas = scheme_.gas;
  const auto face_of = [&](std::size_t at) __attribute__((always_inline))
  {
    return at < mesh_.boundary.size() ? static_cast<std::size_t>(mesh_.boundary[at].face) : mesh_.n_faces;
  };
  std::array<FaceStates<D, Pack>, groups_together> states;
  std::array<HllcMeans<Pack>, groups_together> means;
  std::array<HllcWaves<Pack>, groups_together> waves;
  for (auto first = begin; first < end; first += groups_together * N) {
    std::size_t count = 0, next = b;
    const auto gather = [&](const Numbers<N>& faces) __attribute__((always_inline))
    {
      // A complete group within the mesh finds its cells' numbers in place.
      const auto last = faces[N - 1];
      const bool is_inner = face_of(next) > last && last - faces[0] == N - 1;
      const Index *left = in.owner + faces[0], *right = in.neighbour + faces[0];
      std::array<Index, N> owners, others;
      if (!is_inner) [[unlikely]] {
        owners = cells_beside<N>(in.owner, faces);
        others = cells_beside<N>(in.neighbour, faces);
        left = owners.data();
        right = others.data();
      }
      fetch<N>(in.planes, faces[0] + faces_ahead);
      fetch<N>(in.owner, faces[0] + faces_ahead);
      fetch<N>(in.neighbour, faces[0] + faces_ahead);
      fetch<N / 2>(in.values, static_cast<std::size_t>(right[N - 1]) + cells_ahead);
      if constexpr (is_second) {
        fetch<N>(in.offsets, faces[0] + faces_ahead);
        fetch<N / 2>(in.gradients, static_cast<std::size_t>(right[N - 1]) + cells_ahead);
      }
      auto state = states_at<D, N, is_second>(in, faces, left, right);
      if (!is_inner) [[unlikely]] { // a copy: what a function has the address of does not stay in registers
        auto changed = state;
        for (; face_of(next) <= last; ++next) set_beside<N>(next, face_of(next) - faces[0], changed);
        state = changed;
      }
      states[count] = state;
      if constexpr (flux == Flux::hllc) means[count] = hllc_means<D, Pack>(gas, state);
      ++count;
    };
    for_groups<N>(first, std::min(first + groups_together * N, end), gather);
    if constexpr (flux == Flux::hllc)
      for (std::size_t k = 0; k < count; ++k) waves[k] = hllc_waves<D, Pack>(gas, states[k], means[k]);
    Values<D>* const fluxes = part.fluxes.data() + (first - begin);
    for (std::size_t k = 0; k < count; ++k) {
      const auto rows = turned_back<D, N>(flux == Flux::hllc ? hllc_flux<D, Pack>(gas, states[k], waves[k])
                                                             : roe_flux<D, Pack>(gas, states[k]));
      for (std::size_t i = 0; i < N; ++i) put_row<D>(rows[i], fluxes[k * N + i]);
    }
    for (; b < next; ++b) {
      const auto at = face_of(b) - first;
      set_flux<N>(b, at % N, states[at / N], fluxes[at]);
    }
  }
}

template <int D> MULLION_INLINE void Solver<D>::add_up(Part& part, std::size_t begin, std::size_t end) const
{
  const std::size_t mask = part.residuals.size() - 1, part_end = part.end;
  const Index *face_begin = mesh_.face_begin.data(), first = face_begin[begin];
  const Index* const neighbour = mesh_.neighbour.data() + first;
  Values<D>* const residuals = part.residuals.data();
  Values<D>* total_of_cell = part.totals.data();
  const Values<D>* const fluxes = part.fluxes.data();
  std::size_t f = 0; // of the block's
  for (auto c = begin; c < end; ++c) {
    auto& own = residuals[c & mask];
    auto total = row_of<D>(own);
    put_row<D>(Row<D>{}, own);
    const auto pass = [&](std::size_t face) __attribute__((always_inline))
    {
      const auto row = row_of<D>(fluxes[face]);
      total += row;
      const auto other = static_cast<std::size_t>(neighbour[face]);
      if (other >= part_end) return; // another part's, or none: -1 - b
      auto& residual = residuals[other & mask];
      put_row<D>(row_of<D>(residual) - row, residual);
    };
    const auto last = static_cast<std::size_t>(face_begin[c + 1] - first);
    if (last - f == 2) { // most cells of squares
      pass(f);
      pass(f + 1);
      f = last;
    }
    for (; f < last; ++f) pass(f);
    put_row<D>(total, *total_of_cell++);
  }
}

template <int D>
void Solver<D>::weigh(Part& part, const Step& step, const Stage& stage, std::size_t begin, std::size_t end)
{
  const std::size_t mask = part.swept.size() - 1;
  const bool is_moving = step.v != nullptr, is_local = step.courant > 0.0;
  const FacePlane<D>* const planes = geometry_.planes.data();
  const Index* const neighbour = mesh_.neighbour.data();
  double* const swept = part.swept.data();
  for (auto c = begin; c < end; ++c) {
    auto total = row_of<D>(part.totals[c - begin]);
    double through = swept[c & mask];
    swept[c & mask] = 0.0;
    const auto last = static_cast<std::size_t>(mesh_.face_begin[c + 1]);
    for (auto f = static_cast<std::size_t>(mesh_.face_begin[c]); f < last && is_moving; ++f) {
      const double by_face = planes[f].speed * planes[f].area;
      through += by_face;
      const auto other = static_cast<std::size_t>(neighbour[f]);
      if (other < part.end) swept[other & mask] -= by_face;
    }
    if (is_local && stage.number == 0) rates_[c] = -total[0] / geometry_.volume[c];
    if (stage.sums) {
      put_row<D>(row_of<D>(sums_[c]) + stage.weight * total, sums_[c]);
      swept_sums_[c] += stage.weight * through;
      if (stage.is_last) {
        total = row_of<D>(sums_[c]);
        through = swept_sums_[c];
      }
    }
    const double dt = (stage.is_last ? 1.0 : stage.advance) * (is_local ? local_dt_[c] : step.dt);
    put_row<D>(dt * total, part.totals[c - begin]);
    part.volumes[c - begin] = geometry_.volume[c] + dt * through;
  }
}

template <int D>
template <int N, bool is_second, Flux flux>
MULLION_INLINE void Solver<D>::sweep_loop(Part& part, const Step& step, const Stage& stage)
{
  // Otherwise all cells have one time step and keep their volumes, and only this stage's fluxes count.
  const bool is_weighed = step.v != nullptr || step.courant > 0.0 || stage.sums;
  const double dt = is_weighed ? 1.0 : (stage.is_last ? 1.0 : stage.advance) * step.dt;
  sweep_halo<N, is_second, flux>(part); // lower faces than all of its own
  const auto& boundary = mesh_.boundary;
  const auto is_below = [](const BoundaryFace<D>& face, Index f) { return face.face < f; };
  auto b = static_cast<std::size_t>(
      std::lower_bound(boundary.begin(), boundary.end(), mesh_.face_begin[part.begin], is_below) - boundary.begin());
  for (std::size_t cell = part.begin; cell < part.end; cell += sweep_block) {
    const auto end = std::min(cell + sweep_block, part.end);
    find_fluxes<N, is_second, flux>(part, static_cast<std::size_t>(mesh_.face_begin[cell]),
                                    static_cast<std::size_t>(mesh_.face_begin[end]), b);
    add_up(part, cell, end);
    if (is_weighed) weigh(part, step, stage, cell, end);
    const double* const volumes = is_weighed ? part.volumes.data() : geometry_.volume.data() + cell;
    finish<N>(part, step.amounts.subspan(cell, end - cell), stage.is_last, dt, volumes, cell);
  }
}

template <int D> void Solver<D>::sweep(Part& part, const Step& step, const Stage& stage)
{
  const auto run = [&]<bool is_second, Flux flux>() {
    run_with(
        scheme_.width, [&](auto n)
                           __attribute__((always_inline)) { sweep_loop<n, is_second, flux>(part, step, stage); });
  };
  const bool is_hllc = scheme_.flux == Flux::hllc;
  if (scheme_.order == 2)
    is_hllc ? run.template operator()<true, Flux::hllc>() : run.template operator()<true, Flux::roe>();
  else is_hllc ? run.template operator()<false, Flux::hllc>() : run.template operator()<false, Flux::roe>();
}

template <int D>
template <int N>
MULLION_INLINE void Solver<D>::finish(Part& part, std::span<Values<D>> amounts, bool is_last, double dt,
                                      const double* volumes, std::size_t begin)
{
  Values<D>* const next = next_values_.data() + begin;
  const Values<D>* const totals = part.totals.data();
  for_groups<N>(
      0, amounts.size(), [&](const Numbers<N>& cells) __attribute__((always_inline)) { // of the block's
        fetch<N>(amounts.data(), cells[0] + sweep_block);
        fetch<N>(next, cells[0] + sweep_block);
        fetch<N>(volumes, cells[0] + sweep_block);
        std::array<Row<D>, N> rows;
        for (std::size_t i = 0; i < N; ++i) rows[i] = row_of<D>(amounts[cells[i]]) - dt * row_of<D>(totals[cells[i]]);
        if (is_last)
          for (std::size_t i = 0; i < N; ++i) put_row<D>(rows[i], amounts[cells[i]]);
        const auto volume = lanes_at<N>(volumes, cells);
        const auto w = primitive<D>(scheme_.gas, turned<n_values<D>, Row<D>, N>(rows), volume);
        rows = turned_back<D, N>(w);
        for (std::size_t i = 0; i < N; ++i) put_row<D>(rows[i], next[cells[i]]);
        const auto least = if_positive(volume, if_positive(w[0], w[D + 1]));
        if (!all_positive(least)) [[unlikely]]
          for (std::size_t i = 0; i < N && part.bad_cell < 0; ++i) {
            if (least[i] > 0.0) continue;
            part.bad_cell = static_cast<Index>(begin + cells[i]);
            part.bad_shape = !(volume[i] > 0.0);
            if (part.bad_shape) next[cells[i]][0] = volume[i];
          }
      });
}

// The rest of the class is in stage_inputs.cpp and solver.cpp.
template void Solver<2>::sweep(Part&, const Step&, const Stage&);
template void Solver<3>::sweep(Part&, const Step&, const Stage&);

} // namespace mullion::euler
