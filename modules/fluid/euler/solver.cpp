// The order of things in a step: geometry, values, and four times gradients, fluxes, update.
#include "solver.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <string>

namespace mullion::euler {

template <int D>
Solver<D>::Solver(Mesh<D> mesh, std::vector<Condition<D>> conditions, const Scheme<D>& scheme, int n_threads)
    : mesh_(std::move(mesh)), conditions_(std::move(conditions)), scheme_(scheme), crew_(n_threads)
{
  for (const auto& face : mesh_.boundary) {
    if (face.patch < 0 || static_cast<std::size_t>(face.patch) >= conditions_.size())
      throw MeshError("patch " + std::to_string(face.patch) + " of the boundary has no condition");
    has_prescribed_ = has_prescribed_ || conditions_[static_cast<std::size_t>(face.patch)].kind == Kind::prescribed;
  }
  const std::size_t n = mesh_.n_cells, n_parts = static_cast<std::size_t>(n_threads);
  for (std::size_t p = 0; p < n_parts; ++p) {
    auto part = std::make_unique<Part>();
    part->begin = n * p / n_parts;
    part->end = n * (p + 1) / n_parts;
    parts_.push_back(std::move(part));
  }
  for (std::size_t owner = 0; owner < n && n_parts > 1; ++owner) {
    const auto part_of = [&](std::size_t cell) {
      std::size_t p = cell * n_parts / n;
      while (cell < parts_[p]->begin) --p;
      while (cell >= parts_[p]->end) ++p;
      return p;
    };
    const auto own = part_of(owner);
    for (auto f = mesh_.face_begin[owner]; f < mesh_.face_begin[owner + 1]; ++f) {
      const Index other = mesh_.neighbour[static_cast<std::size_t>(f)];
      if (other < 0) continue;
      const auto theirs = part_of(static_cast<std::size_t>(other));
      if (theirs != own) parts_[theirs]->halo.push_back(f);
    }
  }
  const bool is_second = scheme_.order == 2;
  geometry_.resize(mesh_, is_second);
  values_.resize(n);
  next_values_.resize(n);
  gradients_.resize(is_second ? n : 0);
  for (auto& part : parts_) size_rings(*part);
  sums_.resize(scheme_.integrator == Integrator::rk4 ? n : 0);
  swept_sums_.resize(sums_.size());
  wall_.resize(mesh_.boundary.size());
  stage_pressure_.resize(mesh_.boundary.size());
  prescribed_.resize(has_prescribed_ ? mesh_.boundary.size() : 0);
}

template <int D> void Solver<D>::size_rings(Part& part) const
{
  std::size_t reach = 0; // from the first cell that is not finished to the last that its faces meet
  const auto meet = [&](std::size_t from, Index other) {
    if (other >= 0 && static_cast<std::size_t>(other) < part.end)
      reach = std::max(reach, static_cast<std::size_t>(other) - from);
  };
  for (const Index f : part.halo) meet(part.begin, mesh_.neighbour[static_cast<std::size_t>(f)]);
  for (auto f = static_cast<std::size_t>(mesh_.face_begin[part.begin]);
       f < static_cast<std::size_t>(mesh_.face_begin[part.end]); ++f)
    meet(static_cast<std::size_t>(mesh_.owner[f]), mesh_.neighbour[f]);
  const auto length = std::bit_ceil(reach + sweep_block + 1);
  part.residuals.assign(length, {});
  part.swept.assign(length, 0.0);
  std::size_t most = 0; // faces of a block
  for (std::size_t c = part.begin; c < part.end; c += sweep_block) {
    const auto end = std::min(c + sweep_block, part.end);
    most = std::max(most, static_cast<std::size_t>(mesh_.face_begin[end] - mesh_.face_begin[c]));
  }
  part.fluxes.assign(most + 8, {}); // groups of up to eight: the last one may be incomplete
  part.totals.assign(sweep_block, {});
  part.volumes.assign(sweep_block, 0.0);
}

template <int D> Outcome<D> Solver<D>::place(const Nodes<D>& x)
{
  const auto outcome = place_cells(x);
  if (outcome.kind != Outcome<D>::Kind::fine) return outcome;
  crew_.run([&](int p) {
    const auto& part = *parts_[static_cast<std::size_t>(p)];
    update_planes<D>(mesh_, x, part.begin, part.end, geometry_);
  });
  return outcome;
}

template <int D> Outcome<D> Solver<D>::place_cells(const Nodes<D>& x)
{
  std::vector<BadCellShape> bad(parts_.size());
  crew_.run([&](int p) {
    const auto& part = *parts_[static_cast<std::size_t>(p)];
    bad[static_cast<std::size_t>(p)] = update_cells<D>(mesh_, x, part.begin, part.end, geometry_);
  });
  Outcome<D> outcome;
  for (const auto& b : bad)
    if (b.cell >= 0) {
      outcome.kind = Outcome<D>::Kind::cell_shape;
      outcome.cell = b.cell;
      outcome.value = b.volume;
      return outcome;
    }
  crew_.run([&](int p) {
    const auto& part = *parts_[static_cast<std::size_t>(p)];
    if (!gradients_.empty()) update_reconstruction<D>(mesh_, x, part.begin, part.end, geometry_);
  });
  return outcome;
}

template <int D>
Outcome<D> Solver<D>::advance(std::span<Values<D>> amounts, double t, double dt, const Nodes<D>& x,
                              double courant_limit)
{
  return run({amounts, t, dt, &x, nullptr, 0.0, courant_limit});
}

template <int D>
Outcome<D> Solver<D>::advance_moving(std::span<Values<D>> amounts, double t, double dt, const Nodes<D>& x,
                                     const Nodes<D>& v, double courant_limit)
{
  if (auto outcome = place_cells(x); outcome.kind != Outcome<D>::Kind::fine) return outcome;
  return run({amounts, t, dt, &x, &v, 0.0, courant_limit});
}

template <int D>
Outcome<D> Solver<D>::iterate(std::span<Values<D>> amounts, double t, double courant, const Nodes<D>& x)
{
  local_dt_.resize(mesh_.n_cells);
  rates_.resize(mesh_.n_cells);
  const auto outcome = run({amounts, t, 0.0, &x, nullptr, courant, std::numeric_limits<double>::infinity()});
  double sum = 0.0, volume = 0.0;
  for (std::size_t c = 0; c < mesh_.n_cells; ++c) {
    sum += rates_[c] * rates_[c] * geometry_.volume[c];
    volume += geometry_.volume[c];
  }
  residual_ = std::sqrt(sum / volume);
  return outcome;
}

template <int D> double Solver<D>::unit_step(std::span<const Values<D>> amounts)
{
  const Step step{{}, 0.0, 1.0, nullptr, nullptr, 0.0, 0.0};
  crew_.run([&](int p) {
    auto& part = *parts_[static_cast<std::size_t>(p)];
    find_values(part, amounts);
    find_courant(part, step);
  });
  double largest = 0.0;
  for (const auto& part : parts_) largest = std::max(largest, part->courant);
  return 1.0 / largest;
}

template <int D> Outcome<D> Solver<D>::run(const Step& step)
{
  using Kind = typename Outcome<D>::Kind;
  // Jameson: stages at 1/4, 1/3, 1/2, 1 from the begin, each on planes of its own interval. Classical RK4: planes such
  // that each stage's volumes are exact (farhat2001): sweeps up to 1/2, 1/2, 1 and 4 x (1) - 3 x (1/2) per their time.
  static const std::array<Stage, 4> jameson = {{{0, 1.0 / 4, 0, 0, false, false, 1, 1.0 / 4},
                                                {1, 1.0 / 3, 0, 1.0 / 4, false, false, 1, 1.0 / 3},
                                                {2, 1.0 / 2, 0, 1.0 / 3, false, false, 1, 1.0 / 2},
                                                {3, 0, 1, 1.0 / 2, false, true, 1, 1}}};
  static const std::array<Stage, 4> rk4 = {{{0, 1.0 / 2, 1.0 / 6, 0, true, false, 1, 1.0 / 2},
                                            {1, 1.0 / 2, 1.0 / 3, 1.0 / 2, true, false, 1, 1.0 / 2},
                                            {2, 1, 1.0 / 3, 1.0 / 2, true, false, 1, 1},
                                            {3, 0, 1.0 / 6, 1, true, true, -3, 1.0 / 2, 4, 1}}};
  const auto& stages = scheme_.integrator == Integrator::jameson ? jameson : rk4;
  const bool is_second = scheme_.order == 2;
  for (auto& wall : wall_) wall = {};
  crew_.run([&](int p) {
    auto& part = *parts_[static_cast<std::size_t>(p)];
    part.bad_cell = -1;
    part.bad_shape = false;
    find_values(part, step.amounts);
    for (auto& residual : part.residuals) residual.fill(0.0); // a step that failed leaves some
    std::fill(part.swept.begin(), part.swept.end(), 0.0);
    for (std::size_t c = part.begin; c < part.end && !sums_.empty(); ++c) {
      sums_[c].fill(0.0);
      swept_sums_[c] = 0.0;
    }
  });
  const auto failed = [&]() -> Outcome<D> {
    for (const auto& part : parts_)
      if (part->bad_cell >= 0) {
        Outcome<D> outcome;
        outcome.cell = part->bad_cell;
        const auto c = static_cast<std::size_t>(part->bad_cell);
        outcome.kind = part->bad_shape ? Kind::cell_shape : Kind::no_gas;
        outcome.state = next_values_[c];
        outcome.value = next_values_[c][0];
        return outcome;
      }
    return {};
  };
  Outcome<D> outcome = failed();
  if (outcome.kind != Kind::fine) return outcome;

  for (const auto& stage : stages) {
    if (step.v != nullptr || is_second)
      crew_.run([&](int p) {
        const auto& part = *parts_[static_cast<std::size_t>(p)];
        if (step.v != nullptr) find_planes(part, step, stage);
        if (is_second) find_gradients(part);
      });
    if (stage.number == 0) {
      crew_.run([&](int p) { find_courant(*parts_[static_cast<std::size_t>(p)], step); });
      for (const auto& part : parts_)
        if (part->courant > outcome.courant) {
          outcome.courant = part->courant;
          outcome.courant_cell = part->courant_cell;
        }
      if (outcome.courant > step.courant_limit) {
        outcome.kind = Kind::courant;
        outcome.cell = outcome.courant_cell;
        return outcome;
      }
    }
    if (has_prescribed_) find_prescribed(step, stage.time);
    crew_.run([&](int p) { sweep(*parts_[static_cast<std::size_t>(p)], step, stage); });
    add_wall(step, stage.weight);
    if (const auto bad = failed(); bad.kind != Kind::fine) return bad;
    std::swap(values_, next_values_);
  }
  return outcome;
}

template <int D> void Solver<D>::find_prescribed(const Step& step, double time_of_stage)
{
  for (std::size_t b = 0; b < mesh_.boundary.size(); ++b) {
    const auto& face = mesh_.boundary[b];
    const auto& condition = conditions_[static_cast<std::size_t>(face.patch)];
    if (condition.kind != Kind::prescribed) continue;
    Vec<D> x = Vec<D>::Zero();
    int n = 0;
    for (const Index node : mesh_.face_nodes[static_cast<std::size_t>(face.face)]) {
      if (node < 0) continue;
      x += step.x->col(node);
      if (step.v != nullptr) x += time_of_stage * step.dt * step.v->col(node);
      ++n;
    }
    prescribed_[b] = condition.function(x / n, step.t + time_of_stage * step.dt);
  }
}

template <int D> void Solver<D>::add_wall(const Step& step, double weight)
{
  if (weight == 0.0) return;
  const double dt = weight * step.dt;
  for (std::size_t b = 0; b < mesh_.boundary.size(); ++b) {
    const auto& face = mesh_.boundary[b];
    if (conditions_[static_cast<std::size_t>(face.patch)].kind != Kind::wall) continue;
    const auto& plane = geometry_.planes[static_cast<std::size_t>(face.face)];
    const double p = stage_pressure_[b];
    auto& wall = wall_[b];
    wall.mean_pressure += weight * p;
    for (int d = 0; d < D; ++d) {
      const double area = dt * plane.area * plane.normal[static_cast<std::size_t>(d)];
      wall.impulse[d] += p * area;
      wall.area_time[d] += area;
    }
    wall.work += p * (dt * plane.area * plane.speed);
    wall.swept += dt * plane.area * plane.speed;
  }
}

template <int D> std::size_t Solver<D>::memory() const
{
  const auto of = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
  std::size_t bytes = of(mesh_.order) + of(mesh_.face_begin) + of(mesh_.owner) + of(mesh_.neighbour) +
                      of(mesh_.face_nodes) + of(mesh_.boundary) + of(mesh_.cell_face_begin) + of(mesh_.cell_faces) +
                      of(mesh_.stencil_begin) + of(mesh_.stencil) + of(mesh_.face_shift) + of(mesh_.stencil_shift);
  bytes += of(geometry_.volume) + of(geometry_.centroid) + of(geometry_.offsets) + of(geometry_.weights) +
           of(geometry_.planes);
  bytes += of(values_) + of(next_values_) + of(gradients_) + of(sums_) + of(swept_sums_) + of(local_dt_) + of(rates_) +
           of(prescribed_) + of(stage_pressure_) + of(wall_);
  for (const auto& part : parts_)
    bytes += sizeof(*part) + of(part->halo) + of(part->residuals) + of(part->swept) + of(part->fluxes) +
             of(part->totals) + of(part->volumes);
  return bytes;
}

template class Solver<2>;
template class Solver<3>;

} // namespace mullion::euler
