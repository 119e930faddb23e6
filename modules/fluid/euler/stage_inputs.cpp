// What a stage's sweep starts from: values of the cells, planes of the faces, gradients, and once a step the Courant
// numbers. Faces and cells are taken several at a time, as in the sweep.
#include "groups.hpp"
#include "widths.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

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

// The rest of the class is in sweep.cpp and solver.cpp.
template void Solver<2>::find_values(Part&, std::span<const Values<2>>);
template void Solver<3>::find_values(Part&, std::span<const Values<3>>);
template void Solver<2>::find_planes(const Part&, const Step&, const Stage&);
template void Solver<3>::find_planes(const Part&, const Step&, const Stage&);
template void Solver<2>::find_gradients(const Part&);
template void Solver<3>::find_gradients(const Part&);
template void Solver<2>::find_courant(Part&, const Step&);
template void Solver<3>::find_courant(Part&, const Step&);

} // namespace mullion::euler
