// The passes over the mesh where the time goes: values, planes, gradients, fluxes and update. Faces and cells are taken
// several at a time: what belongs to one stands together in memory, is loaded as a row, and rows of several are turned
// into vectors. What few faces need, boundaries and states that are no gas, is done apart, so that the loops have no
// branches.
#include "solver.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

template <int N> using Numbers = std::array<std::size_t, static_cast<std::size_t>(N)>;
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

/// `first` and those behind it; the last one again where there are fewer.
template <int N> MULLION_INLINE Numbers<N> numbers_from(std::size_t first, std::size_t end)
{
  Numbers<N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = first + i < end ? first + i : end - 1;
  return numbers;
}

template <int D> MULLION_INLINE Row<D> plane_row(const FacePlane<D>& plane)
{
  static_assert(sizeof plane == sizeof(Values<D>));
  Row<D> row{};
  __builtin_memcpy(&row, &plane, sizeof plane);
  return row;
}

/// What the states at faces are made from.
template <int D> struct FaceArrays {
  const Values<D>* values;
  const Gradient<D>* gradients;
  const FacePlane<D>* planes;
  const FaceOffsets<D>* offsets;
  const Index* owner;
  const Index* neighbour;
};

/// Values of one side at the faces, the cells' own where the gradient leads to what is no gas.
template <int D, int N, bool is_second>
MULLION_INLINE std::array<Lanes<N>, n_values<D>> side_of(const FaceArrays<D>& in, const Numbers<N>& faces,
                                                         const Numbers<N>& cells, std::size_t side)
{
  std::array<Row<D>, N> rows;
  for (std::size_t i = 0; i < N; ++i) {
    rows[i] = row_of<D>(in.values[cells[i]]);
    if constexpr (is_second) rows[i] = value_at<D>(rows[i], in.gradients[cells[i]], in.offsets[faces[i]][side]);
  }
  auto state = turned<n_values<D>, Row<D>, N>(rows);
  if constexpr (is_second) {
    const auto is_fine = (state[0] > 0.0) & (state[D + 1] > 0.0);
    if (any(~is_fine)) [[unlikely]] {
      for (std::size_t i = 0; i < N; ++i) rows[i] = row_of<D>(in.values[cells[i]]);
      const auto plain = turned<n_values<D>, Row<D>, N>(rows);
      for (std::size_t v = 0; v < n_values<D>; ++v) state[v] = is_fine ? state[v] : plain[v];
    }
  }
  return state;
}

/// States and planes of faces; on the boundary the gas stands on both sides.
template <int D, int N, bool is_second>
MULLION_INLINE FaceStates<D, Lanes<N>> states_at(const FaceArrays<D>& in, const Numbers<N>& faces)
{
  Numbers<N> owners, others;
  std::array<Row<D>, N> planes;
  for (std::size_t i = 0; i < N; ++i) {
    const Index other = in.neighbour[faces[i]], owner = in.owner[faces[i]];
    owners[i] = static_cast<std::size_t>(owner);
    others[i] = static_cast<std::size_t>(other < 0 ? owner : other);
    planes[i] = plane_row<D>(in.planes[faces[i]]);
  }
  FaceStates<D, Lanes<N>> states;
  const auto plane = turned<D + 2, Row<D>, N>(planes);
  for (std::size_t d = 0; d < D; ++d) states.normal[d] = plane[d];
  states.area = plane[D];
  states.speed = plane[D + 1];
  states.left = side_of<D, N, is_second>(in, faces, owners, 0);
  states.right = side_of<D, N, is_second>(in, faces, others, 1);
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
    for (std::size_t f = begin; f < end; f += N) {
      const auto faces = numbers_from<N>(f, end);
      std::array<Row<2>, N> places, velocities;
      for (std::size_t i = 0; i < N; ++i) {
        const auto a = face_nodes[faces[i]][0], b = face_nodes[faces[i]][1];
        __builtin_memcpy(&places[i], at + a * x_step, 16);
        __builtin_memcpy(reinterpret_cast<char*>(&places[i]) + 16, at + b * x_step, 16);
        __builtin_memcpy(&velocities[i], speed + a * v_step, 16);
        __builtin_memcpy(reinterpret_cast<char*>(&velocities[i]) + 16, speed + b * v_step, 16);
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
    }
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
        for (std::size_t first = part.begin; first < part.end; first += N) {
          const auto cells = numbers_from<N>(first, part.end);
          std::array<Row<D>, N> rows;
          Lanes<N> volume;
          for (std::size_t i = 0; i < N; ++i) {
            rows[i] = row_of<D>(amounts[cells[i]]);
            volume[i] = volumes[cells[i]];
          }
          const auto w = primitive<D>(scheme_.gas, turned<n_values<D>, Row<D>, N>(rows), volume);
          rows = turned_back<D, N>(w);
          for (std::size_t i = 0; i < N; ++i) put_row<D>(rows[i], values_[cells[i]]);
          if (any(~((w[0] > 0.0) & (w[D + 1] > 0.0))) && part.bad_cell < 0) [[unlikely]]
            for (const auto c : cells)
              if (!is_gas<D>(values_[c]) && part.bad_cell < 0) {
                part.bad_cell = static_cast<Index>(c);
                next_values_[c] = values_[c];
              }
        }
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
        for (std::size_t first = part.begin; first < part.end; first += N) {
          const auto cells = numbers_from<N>(first, part.end);
          std::array<Row<D>, N> rows;
          Numbers<N> begin, n_faces;
          std::size_t most = 0;
          Pack volume;
          for (std::size_t i = 0; i < N; ++i) {
            const auto c = cells[i];
            rows[i] = row_of<D>(values_[c]);
            volume[i] = geometry_.volume[c];
            begin[i] = static_cast<std::size_t>(mesh_.cell_face_begin[c]);
            n_faces[i] = static_cast<std::size_t>(mesh_.cell_face_begin[c + 1]) - begin[i];
            most = std::max(most, n_faces[i]);
          }
          const auto w = turned<n_values<D>, Row<D>, N>(rows);
          const Pack sound = root<Pack>(scheme_.gas.gamma * w[D + 1] / w[0]);
          Pack sum{}; // lambda = 1/2 sum (|u_n - s| + c) A
          for (std::size_t k = 0; k < most; ++k) {
            Pack is_face;
            for (std::size_t i = 0; i < N; ++i) {
              const auto at = begin[i] + (k < n_faces[i] ? k : 0);
              rows[i] = plane_row<D>(planes[static_cast<std::size_t>(mesh_.cell_faces[at]) / 2]);
              is_face[i] = k < n_faces[i] ? 1.0 : 0.0;
            }
            const auto plane = turned<D + 2, Row<D>, N>(rows);
            Pack relative = -plane[D + 1];
            for (std::size_t d = 0; d < D; ++d) relative += w[d + 1] * plane[d];
            sum += (size_of<Pack>(relative) + sound) * (plane[D] * is_face);
          }
          const Pack per_step = 0.5 * sum / volume;
          const Pack courant = step.courant > 0.0 ? Pack{} + step.courant : per_step * step.dt;
          for (std::size_t i = 0; i < N && step.courant > 0.0; ++i) local_dt_[cells[i]] = step.courant / per_step[i];
          if (any(~(courant <= part.courant))) // also not-a-number
            for (std::size_t i = 0; i < N; ++i)
              if (!(courant[i] <= part.courant)) {
                part.courant = courant[i];
                part.courant_cell = static_cast<Index>(cells[i]);
              }
        }
      });
}

template <int D>
template <std::size_t N>
void Solver<D>::set_beside(const std::array<std::size_t, N>& faces, FaceStates<D, Lanes<N>>& states) const
{
  for (std::size_t i = 0; i < N; ++i) {
    const Index other = mesh_.neighbour[faces[i]];
    if (other >= 0) continue;
    const auto b = static_cast<std::size_t>(-1 - other);
    const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
    for (std::size_t v = 0; v < n_values<D>; ++v)
      states.right[v][i] = condition.kind == Kind::far_field    ? condition.state[v]
                           : condition.kind == Kind::prescribed ? prescribed_[b][v]
                                                                : states.left[v][i]; // its flux is replaced
  }
}

template <int D>
template <std::size_t N>
void Solver<D>::set_fluxes(const std::array<std::size_t, N>& faces, const FaceStates<D, Lanes<N>>& states,
                           std::array<Lanes<N>, n_values<D>>& fluxes)
{
  for (std::size_t i = 0; i < N; ++i) {
    const Index other = mesh_.neighbour[faces[i]];
    if (other >= 0) continue;
    const auto b = static_cast<std::size_t>(-1 - other);
    const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
    if (is_upwinded(condition.kind)) continue;
    const auto& plane = geometry_.planes[faces[i]];
    Values<D> w;
    for (std::size_t v = 0; v < w.size(); ++v) w[v] = states.left[v][i];
    if (condition.kind == Kind::wall)
      stage_pressure_[b] = wall_pressure<D>(scheme_.gas, w, along<D>(w, plane.normal.data()) - plane.speed);
    const auto flux = boundary_flux<D>(scheme_.gas, condition, w, plane.normal.data(), plane.speed);
    for (std::size_t v = 0; v < w.size(); ++v) fluxes[v][i] = flux[v] * plane.area;
  }
}

template <int D>
template <int N, bool is_second, Flux flux>
MULLION_INLINE void Solver<D>::sweep_loop(Part& part, const Step& step, const Stage& stage)
{
  const FaceArrays<D> in{values_.data(),           gradients_.data(),  geometry_.planes.data(),
                         geometry_.offsets.data(), mesh_.owner.data(), mesh_.neighbour.data()};
  const bool is_moving = step.v != nullptr;
  const Gas gas = scheme_.gas;
  Values<D>* const residuals = part.residuals.data();
  double* const swept = part.swept.data();
  const std::size_t mask = part.residuals.size() - 1;
  const auto add = [=](std::size_t cell, const Row<D>& row) __attribute__((always_inline))
  {
    auto& residual = residuals[cell & mask];
    put_row<D>(row_of<D>(residual) + row, residual);
  };

  // Faces to add up, the first `count` of them; those of a halo enter their neighbours only.
  const auto add_faces = [&](const Numbers<N>& faces, std::size_t count, bool is_own) __attribute__((always_inline))
  {
    auto states = states_at<D, N, is_second>(in, faces);
    Index lowest = 0;
    for (const auto f : faces) lowest = std::min(lowest, in.neighbour[f]);
    if (lowest < 0) [[unlikely]] { // copies: what a function has the address of does not stay in registers
      auto changed = states;
      set_beside<N>(faces, changed);
      states = changed;
    }
    auto fluxes = flux == Flux::hllc ? hllc_flux<D, Lanes<N>>(gas, states) : roe_flux<D, Lanes<N>>(gas, states);
    if (lowest < 0) [[unlikely]] {
      const auto met = states;
      auto changed = fluxes;
      set_fluxes<N>(faces, met, changed);
      fluxes = changed;
    }
    const auto rows = turned_back<D, N>(fluxes);
    const Lanes<N> through = states.speed * states.area;
    for (std::size_t i = 0; i < count; ++i) {
      const auto owner = static_cast<std::size_t>(in.owner[faces[i]]);
      const Index other = in.neighbour[faces[i]];
      const bool is_mine = other >= 0 && static_cast<std::size_t>(other) < part.end;
      if (is_own) add(owner, rows[i]);
      if (is_mine) add(static_cast<std::size_t>(other), -rows[i]);
      if (is_moving) {
        if (is_own) swept[owner & mask] += through[i];
        if (is_mine) swept[static_cast<std::size_t>(other) & mask] -= through[i];
      }
    }
  };

  for (std::size_t first = 0; first < part.halo.size(); first += N) { // lower faces than all of its own
    const auto at = numbers_from<N>(first, part.halo.size());
    Numbers<N> faces;
    for (std::size_t i = 0; i < N; ++i) faces[i] = static_cast<std::size_t>(part.halo[at[i]]);
    add_faces(faces, std::min<std::size_t>(N, part.halo.size() - first), false);
  }
  for (std::size_t cell = part.begin; cell < part.end; cell += sweep_block) {
    const auto cells_end = std::min(cell + sweep_block, part.end);
    const auto faces_end = static_cast<std::size_t>(mesh_.face_begin[cells_end]);
    auto f = static_cast<std::size_t>(mesh_.face_begin[cell]);
    for (; f + N <= faces_end; f += N) add_faces(numbers_from<N>(f, f + N), N, true);
    if (f < faces_end) add_faces(numbers_from<N>(f, faces_end), faces_end - f, true);
    finish<N>(part, step, stage, cell, cells_end); // all of their faces are in
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
MULLION_INLINE void Solver<D>::finish(Part& part, const Step& step, const Stage& stage, std::size_t begin,
                                      std::size_t end)
{
  const std::size_t mask = part.residuals.size() - 1;
  const bool is_moving = step.v != nullptr, is_local = step.courant > 0.0, is_last = stage.is_last;
  const double part_of_dt = is_last ? 1.0 : stage.advance;
  const double* const volumes = geometry_.volume.data();
  Values<D>* const amounts = step.amounts.data();
  Values<D>* const next = next_values_.data();
  for (std::size_t first = begin; first < end; first += N) {
    const auto cells = numbers_from<N>(first, end);
    const auto count = std::min<std::size_t>(N, end - first);
    std::array<Row<D>, N> rows;
    Lanes<N> volume;
    for (std::size_t i = 0; i < N; ++i) {
      const auto c = cells[i];
      const double dt = part_of_dt * (is_local ? local_dt_[c] : step.dt);
      auto total = row_of<D>(part.residuals[c & mask]);
      double through = is_moving ? part.swept[c & mask] : 0.0;
      if (is_local && stage.number == 0) rates_[c] = -total[0] / volumes[c];
      if (stage.sums) {
        if (i < count) {
          put_row<D>(row_of<D>(sums_[c]) + stage.weight * total, sums_[c]);
          swept_sums_[c] += stage.weight * through;
        }
        if (is_last) {
          total = row_of<D>(sums_[c]);
          through = swept_sums_[c];
        }
      }
      rows[i] = row_of<D>(amounts[c]) - dt * total;
      volume[i] = volumes[c] + dt * through;
    }
    for (std::size_t i = 0; i < count; ++i) {
      put_row<D>(Row<D>{}, part.residuals[cells[i] & mask]);
      if (is_moving) part.swept[cells[i] & mask] = 0.0;
      if (is_last) put_row<D>(rows[i], amounts[cells[i]]);
    }
    const auto w = primitive<D>(scheme_.gas, turned<n_values<D>, Row<D>, N>(rows), volume);
    rows = turned_back<D, N>(w);
    for (std::size_t i = 0; i < count; ++i) put_row<D>(rows[i], next[cells[i]]);
    const auto is_fine = (volume > 0.0) & (w[0] > 0.0) & (w[D + 1] > 0.0);
    if (any(~is_fine)) [[unlikely]]
      for (std::size_t i = 0; i < count && part.bad_cell < 0; ++i) {
        if (is_fine[i]) continue;
        part.bad_cell = static_cast<Index>(cells[i]);
        part.bad_shape = !(volume[i] > 0.0);
        if (part.bad_shape) next[cells[i]][0] = volume[i];
      }
  }
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
