// The passes over the mesh where the time goes: values, planes, gradients, fluxes and update.
#include "solver.hpp"

#include <algorithm>
#include <cmath>

namespace mullion::euler {

namespace {

template <int D> struct GradientPass {
  const Mesh<D>& mesh;
  const Geometry<D>& geometry;
  const LimiterOptions<D>& limiter;
  const std::vector<Values<D>>& values;
  std::vector<Gradient<D>>& gradients;
};

template <int D>
[[gnu::always_inline]] inline void find_gradients_loop(const GradientPass<D>& pass, std::size_t begin, std::size_t end)
{
  const auto& mesh = pass.mesh;
  const bool is_limited = pass.limiter.limiter != Limiter::none;
  constexpr std::size_t n = n_values<D>;
  for (std::size_t c = begin; c < end; ++c) {
    const Values<D> own = pass.values[c];
    Gradient<D> gradient{};
    Spread<D> spread;
    const auto last = static_cast<std::size_t>(mesh.stencil_begin[c + 1]);
    for (auto e = static_cast<std::size_t>(mesh.stencil_begin[c]); e < last; ++e) {
      const auto& other = pass.values[static_cast<std::size_t>(mesh.stencil[e])];
      const auto& weight = pass.geometry.weights[e];
      Values<D> jump;
      for (std::size_t v = 0; v < n; ++v) jump[v] = other[v] - own[v];
      for (int d = 0; d < D; ++d)
        for (std::size_t v = 0; v < n; ++v) gradient[d][v] += weight[d] * jump[v];
      for (std::size_t v = 0; v < n; ++v) spread.below[v] = jump[v] < spread.below[v] ? jump[v] : spread.below[v];
      for (std::size_t v = 0; v < n; ++v) spread.above[v] = jump[v] > spread.above[v] ? jump[v] : spread.above[v];
    }
    if (is_limited) {
      const auto first = static_cast<std::size_t>(mesh.cell_face_begin[c]);
      const auto n_faces = static_cast<std::size_t>(mesh.cell_face_begin[c + 1]) - first;
      limit_gradient<D>(
          pass.limiter, pass.geometry.volume[c], spread, n_faces,
          [&](std::size_t k) -> const std::array<double, D>& {
            const Index code = mesh.cell_faces[first + k];
            const auto& offsets = pass.geometry.offsets[static_cast<std::size_t>(code / 2)];
            return code % 2 == 0 ? offsets.owner : offsets.neighbour;
          },
          gradient);
    }
    pass.gradients[c] = gradient;
  }
}

#if defined(__x86_64__)
// All variables of a cell at a time; the bits are the same, see flux.cpp.
template <int D>
[[gnu::target("avx2")]] void find_gradients_wide(const GradientPass<D>& pass, std::size_t begin, std::size_t end)
{
  find_gradients_loop<D>(pass, begin, end);
}
#endif

} // namespace

template <int D> void Solver<D>::find_values(Part& part, std::span<const Values<D>> amounts)
{
  for (std::size_t c = part.begin; c < part.end; ++c) {
    values_[c] = primitive<D>(scheme_.gas, amounts[c], geometry_.volume[c]);
    if (!is_gas<D>(values_[c]) && part.bad_cell < 0) {
      part.bad_cell = static_cast<Index>(c);
      next_values_[c] = values_[c];
    }
  }
}

template <int D> void Solver<D>::find_planes(const Part& part, const Step& step, const Stage& stage)
{
  const auto end = static_cast<std::size_t>(mesh_.face_begin[part.end]);
  for (auto f = static_cast<std::size_t>(mesh_.face_begin[part.begin]); f < end; ++f) {
    const auto& nodes = mesh_.face_nodes[f];
    const auto near = sweep_of<D>(nodes, *step.x, *step.v, stage.near_part * step.dt);
    Vec<D> area = stage.near * near.area;
    double rate = stage.near * near.volume / (stage.near_part * step.dt);
    if (stage.far != 0.0) {
      const auto far = sweep_of<D>(nodes, *step.x, *step.v, stage.far_part * step.dt);
      area += stage.far * far.area;
      rate += stage.far * far.volume / (stage.far_part * step.dt);
    }
    geometry_.planes[f] = plane_of<D>(area, rate);
  }
}

template <int D> void Solver<D>::find_gradients(const Part& part)
{
  const GradientPass<D> pass{mesh_, geometry_, scheme_.limiter, values_, gradients_};
#if defined(__x86_64__)
  static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
  if (is_wide && scheme_.width == Width::best) return find_gradients_wide<D>(pass, part.begin, part.end);
#endif
  find_gradients_loop<D>(pass, part.begin, part.end);
}

template <int D> void Solver<D>::find_courant(Part& part, const Step& step)
{
  part.courant = 0.0;
  part.courant_cell = -1;
  for (std::size_t c = part.begin; c < part.end; ++c) {
    const auto& w = values_[c];
    const double sound = sound_speed<D>(scheme_.gas, w);
    double sum = 0.0; // lambda = 1/2 sum (|u_n - s| + c) A
    for (auto k = mesh_.cell_face_begin[c]; k < mesh_.cell_face_begin[c + 1]; ++k) {
      const auto& plane = geometry_.planes[static_cast<std::size_t>(mesh_.cell_faces[static_cast<std::size_t>(k)] / 2)];
      sum += (std::abs(along<D>(w, plane.normal.data()) - plane.speed) + sound) * plane.area;
    }
    const double per_step = 0.5 * sum / geometry_.volume[c];
    if (step.courant > 0.0) local_dt_[c] = step.courant / per_step;
    const double courant = step.courant > 0.0 ? step.courant : per_step * step.dt;
    if (!(courant <= part.courant)) { // also not-a-number
      part.courant = courant;
      part.courant_cell = static_cast<Index>(c);
    }
  }
}

template <int D> void Solver<D>::gather(Part& part, std::size_t k, std::size_t face, std::size_t owner)
{
  auto& batch = part.batch;
  const bool is_second = scheme_.order == 2;
  const auto& plane = geometry_.planes[face];
  batch.area[k] = plane.area;
  batch.speed[k] = plane.speed;
  for (int d = 0; d < D; ++d) batch.normal[d][k] = plane.normal[d];
  const auto left =
      is_second ? value_at<D>(values_[owner], gradients_[owner], geometry_.offsets[face].owner) : values_[owner];
  for (std::size_t v = 0; v < n_values<D>; ++v) batch.left[v][k] = left[v];
  const Index other = mesh_.neighbour[face];
  if (other >= 0) {
    const auto n = static_cast<std::size_t>(other);
    const auto right =
        is_second ? value_at<D>(values_[n], gradients_[n], geometry_.offsets[face].neighbour) : values_[n];
    for (std::size_t v = 0; v < n_values<D>; ++v) batch.right[v][k] = right[v];
    return;
  }
  const auto b = static_cast<std::size_t>(-1 - other);
  const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
  const auto& right = condition.kind == Kind::far_field    ? condition.state
                      : condition.kind == Kind::prescribed ? prescribed_[b]
                                                           : left; // replaced below
  for (std::size_t v = 0; v < n_values<D>; ++v) batch.right[v][k] = right[v];
  if (!is_upwinded(condition.kind)) part.boundary[part.n_boundary++] = {k, b};
}

template <int D> void Solver<D>::flux_between(Part& part, std::size_t n)
{
  auto& batch = part.batch;
  if (scheme_.flux == Flux::hllc) hllc_fluxes<D>(scheme_.gas, batch, n, scheme_.width);
  else roe_fluxes<D>(scheme_.gas, batch, n);
  for (std::size_t i = 0; i < part.n_boundary; ++i) {
    const auto [k, b] = part.boundary[i];
    const auto& condition = conditions_[static_cast<std::size_t>(mesh_.boundary[b].patch)];
    const auto& plane = geometry_.planes[static_cast<std::size_t>(mesh_.boundary[b].face)];
    Values<D> w;
    for (std::size_t v = 0; v < w.size(); ++v) w[v] = batch.left[v][k];
    if (condition.kind == Kind::wall)
      stage_pressure_[b] = wall_pressure<D>(scheme_.gas, w, along<D>(w, plane.normal.data()) - plane.speed);
    const auto flux = boundary_flux<D>(scheme_.gas, condition, w, plane.normal.data(), plane.speed);
    for (std::size_t v = 0; v < w.size(); ++v) batch.flux[v][k] = flux[v] * plane.area;
  }
}

template <int D> void Solver<D>::sweep(Part& part, const Step& step, const Stage& stage)
{
  const auto& batch = part.batch;
  constexpr std::size_t n = n_values<D>;
  const auto add = [&](std::size_t cell, double sign, std::size_t k) {
    auto& residual = residuals_[cell];
    for (std::size_t v = 0; v < n; ++v) residual[v] += sign * batch.flux[v][k];
    residual[n] += sign * (batch.speed[k] * batch.area[k]);
  };
  for (std::size_t first = 0; first < part.halo.size(); first += batch.capacity) { // lower faces than all of its own
    const auto count = std::min(batch.capacity, part.halo.size() - first);
    part.n_boundary = 0;
    for (std::size_t k = 0; k < count; ++k) {
      const auto [face, owner] = part.halo[first + k];
      gather(part, k, static_cast<std::size_t>(face), static_cast<std::size_t>(owner));
    }
    flux_between(part, count);
    for (std::size_t k = 0; k < count; ++k)
      add(static_cast<std::size_t>(mesh_.neighbour[static_cast<std::size_t>(part.halo[first + k].first)]), -1.0, k);
  }
  for (std::size_t cell = part.begin; cell < part.end;) {
    const std::size_t first_cell = cell;
    const auto first_face = static_cast<std::size_t>(mesh_.face_begin[cell]);
    part.n_boundary = 0;
    std::size_t count = 0;
    for (; cell < part.end; ++cell) {
      const auto begin = static_cast<std::size_t>(mesh_.face_begin[cell]);
      const auto end = static_cast<std::size_t>(mesh_.face_begin[cell + 1]);
      if (end - first_face > batch.capacity) break;
      for (std::size_t face = begin; face < end; ++face) gather(part, count++, face, cell);
    }
    flux_between(part, count);
    for (std::size_t c = first_cell, k = 0; c < cell; ++c) {
      const auto n_faces = static_cast<std::size_t>(mesh_.face_begin[c + 1] - mesh_.face_begin[c]);
      for (std::size_t i = 0; i < n_faces; ++i, ++k) {
        add(c, 1.0, k);
        const Index other = mesh_.neighbour[first_face + k];
        if (other >= 0 && static_cast<std::size_t>(other) < part.end) add(static_cast<std::size_t>(other), -1.0, k);
      }
      finish(part, step, stage, c); // all of its faces are in
    }
  }
}

template <int D> void Solver<D>::finish(Part& part, const Step& step, const Stage& stage, std::size_t cell)
{
  constexpr std::size_t n = n_values<D>;
  auto& residual = residuals_[cell];
  const double dt = step.courant > 0.0 ? local_dt_[cell] : step.dt;
  if (stage.number == 0 && step.courant > 0.0) rates_[cell] = -residual[0] / geometry_.volume[cell];
  const std::array<double, D + 3>* total = &residual;
  double part_of_dt = stage.advance;
  if (stage.sums) {
    auto& sum = sums_[cell];
    for (std::size_t v = 0; v <= n; ++v) sum[v] += stage.weight * residual[v];
    if (stage.is_last) total = &sum;
  }
  if (stage.is_last) part_of_dt = 1.0;
  Values<D> amounts = step.amounts[cell];
  for (std::size_t v = 0; v < n; ++v) amounts[v] -= part_of_dt * dt * (*total)[v];
  const double volume = geometry_.volume[cell] + part_of_dt * dt * (*total)[n];
  residual.fill(0.0);
  next_values_[cell] = primitive<D>(scheme_.gas, amounts, volume);
  if (stage.is_last) step.amounts[cell] = amounts;
  if (part.bad_cell >= 0) return;
  if (!(volume > 0.0)) {
    part.bad_cell = static_cast<Index>(cell);
    part.bad_shape = true;
    next_values_[cell][0] = volume;
  } else if (!is_gas<D>(next_values_[cell])) {
    part.bad_cell = static_cast<Index>(cell);
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
