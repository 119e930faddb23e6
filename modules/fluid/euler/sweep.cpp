// The passes over the mesh where the time goes: values, planes, gradients, fluxes and update. Faces and cells are taken
// several at a time: what belongs to one stands together in memory, is loaded as a row, and rows of several are turned
// into vectors. What few faces need, boundaries and states that are no gas, is done apart, so that the loops have no
// branches.
#include "groups.hpp"
#include "solver.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

template <int N> using Count = std::integral_constant<int, N>;

// Eight or four at a time where the processor can. The bits are the same: each operation is rounded by itself, no
// product is contracted with a sum (-ffp-contract=off), and no lane sees another.
#if defined(__x86_64__)
template <class Loop> [[gnu::target("avx512f,avx512dq,avx512vl"), gnu::noinline]] void run_widest(const Loop& loop)
{
  loop(Count<8>{});
}
template <class Loop> [[gnu::target("avx2"), gnu::noinline]] void run_wide(const Loop& loop) { loop(Count<4>{}); }
#endif

/// Runs a loop with vectors that this processor has. It gets the number of lanes, and must be inlined always.
template <class Loop> void run_with(Width width, const Loop& loop)
{
#if defined(__x86_64__)
  static const Width best = __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512dq") != 0 &&
                                    __builtin_cpu_supports("avx512vl") != 0
                                ? Width::eight
                            : __builtin_cpu_supports("avx2") != 0 ? Width::four
                                                                  : Width::baseline;
  const auto chosen = std::min(width, best);
  if (chosen == Width::eight) return run_widest(loop);
  if (chosen == Width::four) return run_wide(loop);
#else
  (void)width;
#endif
  loop(Count<4>{});
}

template <int D> MULLION_INLINE Row<D> plane_row(const FacePlane<D>& plane)
{
  static_assert(sizeof plane == sizeof(Values<D>));
  Row<D> row{};
  __builtin_memcpy(&row, &plane, sizeof plane);
  return row;
}

constexpr std::size_t faces_ahead = 128; ///< memory is asked for so early: some hundred nanoseconds
constexpr std::size_t cells_ahead = faces_ahead / 2;
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

/// Planes of moving faces in the plane, several at a time: as sweep_of() and plane_of().
template <int D, int N>
MULLION_INLINE void planes_of(const Mesh<D>& mesh, const Nodes<D>& x, const Nodes<D>& v, double dt,
                              const SolverStage& stage, std::size_t begin, std::size_t end, FacePlane<D>* planes)
{
  if constexpr (D == 2) {
    using Pack = Lanes<N>;
    const auto* face_nodes = mesh.face_nodes.data();
    const double *at = x.data(), *speed = v.data();
    const auto x_step = x.outerStride(), v_step = v.outerStride();
    const double near_dt = 0.5 * stage.near_part * dt, far_dt = 0.5 * stage.far_part * dt;
    const auto both = [](const double* first, const double* second) __attribute__((always_inline))
    {
      Lanes<2> a, b;
      __builtin_memcpy(&a, first, sizeof a);
      __builtin_memcpy(&b, second, sizeof b);
      return __builtin_shufflevector(a, b, 0, 1, 2, 3);
    };
    for_groups<N>(
        begin, end, [&](const Numbers<N>& faces) __attribute__((always_inline)) {
          fetch<N>(face_nodes, faces[0] + faces_ahead);
          fetch<N>(planes, faces[0] + faces_ahead);
          std::array<Row<2>, N> places, velocities;
          for (std::size_t i = 0; i < N; ++i) {
            const auto a = face_nodes[faces[i]][0], b = face_nodes[faces[i]][1];
            places[i] = both(at + a * x_step, at + b * x_step);
            velocities[i] = both(speed + a * v_step, speed + b * v_step);
          }
          const auto [xa, ya, xb, yb] = turned<4, Row<2>, N>(places);
          const auto [ua, va, ub, vb] = turned<4, Row<2>, N>(velocities);
          const Pack along_x = xb - xa, along_y = yb - ya, turn_x = ub - ua, turn_y = vb - va;
          const Pack sum_x = 0.5 * (ua + ub), sum_y = 0.5 * (va + vb);
          Pack area_x = along_y + near_dt * turn_y, area_y = -(along_x + near_dt * turn_x);
          Pack rate = sum_x * area_x + sum_y * area_y;
          if (stage.far != 0.0) {
            const Pack far_x = along_y + far_dt * turn_y, far_y = -(along_x + far_dt * turn_x);
            const Pack far_rate = sum_x * far_x + sum_y * far_y;
            area_x = stage.near * area_x + stage.far * far_x;
            area_y = stage.near * area_y + stage.far * far_y;
            rate = stage.near * rate + stage.far * far_rate;
          }
          const Pack area = root<Pack>(area_x * area_x + area_y * area_y);
          const Pack per_area = 1.0 / area;
          const auto rows = turned_back<2, N, 4>({area_x * per_area, area_y * per_area, area, rate * per_area});
          for (std::size_t i = 0; i < N; ++i)
            __builtin_memcpy(static_cast<void*>(&planes[faces[i]]), &rows[i], sizeof rows[i]);
        });
  } else {
    for (std::size_t f = begin; f < end; ++f) {
      const auto near = sweep_of<D>(mesh.face_nodes[f], x, v, stage.near_part * dt);
      Vec<D> area = stage.near * near.area;
      double rate = stage.near * near.volume / (stage.near_part * dt);
      if (stage.far != 0.0) {
        const auto far = sweep_of<D>(mesh.face_nodes[f], x, v, stage.far_part * dt);
        area += stage.far * far.area;
        rate += stage.far * far.volume / (stage.far_part * dt);
      }
      planes[f] = plane_of<D>(area, rate);
    }
  }
}

template <int D>
MULLION_INLINE void gradients_of(const Mesh<D>& mesh, const Geometry<D>& geometry, const LimiterOptions<D>& limiter,
                                 const Values<D>* values, std::size_t begin, std::size_t end, Gradient<D>* gradients)
{
  const bool is_limited = limiter.limiter != Limiter::none;
  const auto* weights = geometry.weights.data();
  const auto* offsets = geometry.offsets.data();
  const Index *stencil = mesh.stencil.data(), *cell_faces = mesh.cell_faces.data();
  for (std::size_t c = begin; c < end; ++c) {
    const auto own = row_of<D>(values[c]);
    Slopes<D> slopes{};
    Spread<D> spread;
    const auto last = static_cast<std::size_t>(mesh.stencil_begin[c + 1]);
    for (auto e = static_cast<std::size_t>(mesh.stencil_begin[c]); e < last; ++e)
      add_to_gradient<D>(weights[e], row_of<D>(values[static_cast<std::size_t>(stencil[e])]) - own, slopes, spread);
    if (is_limited) {
      const auto first = static_cast<std::size_t>(mesh.cell_face_begin[c]);
      const auto n_faces = static_cast<std::size_t>(mesh.cell_face_begin[c + 1]) - first;
      limit_gradient<D>(
          limiter, geometry.volume[c], spread, n_faces,
          [=](std::size_t k) __attribute__((always_inline))->const std::array<double, D>& {
            const auto code = static_cast<std::size_t>(cell_faces[first + k]);
            return offsets[code / 2][code % 2];
          },
          slopes);
    }
    for (std::size_t d = 0; d < D; ++d) put_row<D>(slopes[d], gradients[c][d]);
  }
}

} // namespace

template <int D> void Solver<D>::find_values(Part& part, std::span<const Values<D>> amounts)
{
  run_with(
      scheme_.width, [&](auto n) __attribute__((always_inline)) {
        constexpr int N = n;
        const double* volumes = geometry_.volume.data();
        for_groups<N>(
            part.begin, part.end, [&](const Numbers<N>& cells) __attribute__((always_inline)) {
              std::array<Row<D>, N> rows;
              for (std::size_t i = 0; i < N; ++i) rows[i] = row_of<D>(amounts[cells[i]]);
              const auto volume = lanes_at<N>(volumes, cells);
              const auto w = primitive<D>(scheme_.gas, turned<n_values<D>, Row<D>, N>(rows), volume);
              rows = turned_back<D, N>(w);
              for (std::size_t i = 0; i < N; ++i) put_row<D>(rows[i], values_[cells[i]]);
              if (!all_positive(if_positive(w[0], w[D + 1])) && part.bad_cell < 0) [[unlikely]]
                for (const auto c : cells)
                  if (!is_gas<D>(values_[c]) && part.bad_cell < 0) {
                    part.bad_cell = static_cast<Index>(c);
                    next_values_[c] = values_[c];
                  }
            });
      });
}

template <int D> void Solver<D>::find_planes(const Part& part, const Step& step, const Stage& stage)
{
  run_with(
      scheme_.width, [&](auto n) __attribute__((always_inline)) {
        planes_of<D, n>(mesh_, *step.x, *step.v, step.dt, stage, static_cast<std::size_t>(mesh_.face_begin[part.begin]),
                        static_cast<std::size_t>(mesh_.face_begin[part.end]), geometry_.planes.data());
      });
}

template <int D> void Solver<D>::find_gradients(const Part& part)
{
  run_with(
      scheme_.width, [&](auto) __attribute__((always_inline)) {
        gradients_of<D>(mesh_, geometry_, scheme_.limiter, values_.data(), part.begin, part.end, gradients_.data());
      });
}

template <int D> void Solver<D>::find_courant(Part& part, const Step& step)
{
  part.courant = 0.0;
  part.courant_cell = -1;
  run_with(
      scheme_.width, [&](auto n) __attribute__((always_inline)) {
        constexpr int N = n;
        using Pack = Lanes<N>;
        const auto* planes = geometry_.planes.data();
        const Index *faces = mesh_.cell_faces.data(), *face_begin = mesh_.cell_face_begin.data();
        for_groups<N>(
            part.begin, part.end, [&](const Numbers<N>& cells) __attribute__((always_inline)) {
              fetch<2 * N>(planes, static_cast<std::size_t>(mesh_.face_begin[cells[0]]) + faces_ahead);
              fetch<4 * N>(faces, static_cast<std::size_t>(face_begin[cells[0]]) + 4 * cells_ahead);
              fetch<N>(values_.data(), cells[0] + cells_ahead);
              fetch<N>(geometry_.volume.data(), cells[0] + cells_ahead);
              std::array<Row<D>, N> rows;
              Numbers<N> begin, n_faces;
              std::size_t most = 0, fewest = most_cell_faces<D>;
              for (std::size_t i = 0; i < N; ++i) {
                const auto c = cells[i];
                rows[i] = row_of<D>(values_[c]);
                begin[i] = static_cast<std::size_t>(face_begin[c]);
                n_faces[i] = static_cast<std::size_t>(face_begin[c + 1]) - begin[i];
                most = std::max(most, n_faces[i]);
                fewest = std::min(fewest, n_faces[i]);
              }
              const auto volume = lanes_at<N>(geometry_.volume.data(), cells);
              const auto w = turned<n_values<D>, Row<D>, N>(rows);
              const Pack sound = root<Pack>(scheme_.gas.gamma * w[D + 1] / w[0]);
              Pack sum{}; // lambda = 1/2 sum (|u_n - s| + c) A
              const auto add_faces = [&](std::size_t k, bool all_have_it) __attribute__((always_inline))
              {
                Pack is_face = Pack{} + 1.0;
                for (std::size_t i = 0; i < N; ++i) {
                  const bool has_it = all_have_it || k < n_faces[i];
                  rows[i] = plane_row<D>(planes[static_cast<std::size_t>(faces[begin[i] + (has_it ? k : 0)]) / 2]);
                  if (!has_it) is_face[i] = 0.0;
                }
                const auto plane = turned<D + 2, Row<D>, N>(rows);
                Pack relative = -plane[D + 1];
                for (std::size_t d = 0; d < D; ++d) relative += w[d + 1] * plane[d];
                sum += (size_of<Pack>(relative) + sound) * (plane[D] * is_face);
              };
              for (std::size_t k = 0; k < fewest; ++k) add_faces(k, true);
              for (std::size_t k = fewest; k < most; ++k) add_faces(k, false);
              const Pack per_step = 0.5 * sum / volume;
              const Pack courant = step.courant > 0.0 ? Pack{} + step.courant : per_step * step.dt;
              for (std::size_t i = 0; i < N && step.courant > 0.0; ++i)
                local_dt_[cells[i]] = step.courant / per_step[i];
              if (any_above<Pack>(courant, Pack{} + part.courant)) // also not-a-number
                for (std::size_t i = 0; i < N; ++i)
                  if (!(courant[i] <= part.courant)) {
                    part.courant = courant[i];
                    part.courant_cell = static_cast<Index>(cells[i]);
                  }
            });
      });
}

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

// The rest of the class is in solver.cpp.
template void Solver<2>::find_values(Part&, std::span<const Values<2>>);
template void Solver<3>::find_values(Part&, std::span<const Values<3>>);
template void Solver<2>::find_planes(const Part&, const Step&, const Stage&);
template void Solver<3>::find_planes(const Part&, const Step&, const Stage&);
template void Solver<2>::find_gradients(const Part&);
template void Solver<3>::find_gradients(const Part&);
template void Solver<2>::find_courant(Part&, const Step&);
template void Solver<3>::find_courant(Part&, const Step&);
template void Solver<2>::sweep(Part&, const Step&, const Stage&);
template void Solver<3>::sweep(Part&, const Step&, const Stage&);

} // namespace mullion::euler
