#include "overlay_operators.hpp"

#include "shape_functions.hpp"

#include <algorithm>

namespace mullion::surface {

OverlayAssembly::OverlayAssembly(const SurfaceMesh& source, const SurfaceMesh& target, Location source_location,
                                 Metric metric, MassMetric mass, SourceMass source_mass)
    : source_(source), target_(target), location_(source_location), metric_(metric), mass_(mass),
      has_source_mass_(source_mass == SourceMass::factorised)
{
  is_covered_.assign(static_cast<std::size_t>(source.n_faces()), false);
  if (mass == MassMetric::same) target_mass_.assign(static_cast<std::size_t>(target.n_faces()), {});
}

void OverlayAssembly::add(const Subelement& piece)
{
  if (!pieces_.empty() && pieces_.front().source_face != piece.source_face) integrate_face();
  pieces_.push_back(piece);
}

void OverlayAssembly::integrate_face()
{
  const auto face = pieces_.front().source_face;
  points_.clear();
  const double coverage = add_points_of_face(source_, target_, pieces_, metric_, points_);
  is_covered_[static_cast<std::size_t>(face)] = coverage > 0.0;
  pieces_.clear();
  sum_points(face);
}

void OverlayAssembly::attach_uncovered(const FaceTree& target_tree)
{
  constexpr int points_a_direction = 2;
  if (target_.n_faces() == 0) return;
  PointSet set;
  set.coverage.assign(static_cast<std::size_t>(source_.n_faces()), 0.0);
  for (std::int32_t face = 0; face < source_.n_faces(); ++face) {
    if (is_covered_[static_cast<std::size_t>(face)] || !(face_measure(source_, face) > 0.0)) continue;
    set.points.clear();
    add_closest_points(source_, target_tree, std::span(&face, 1), points_a_direction, set);
    points_ = set.points;
    sum_points(face);
  }
}

void OverlayAssembly::sum_points(std::int32_t face)
{
  const auto source_nodes = source_.face(face);
  const std::size_t n = source_nodes.size();
  target_nodes_.clear(), local_.clear();

  // Few target nodes lie near a source face: a list is searched faster than anything cleverer.
  const auto column_of = [&](std::int32_t node) {
    const auto found = std::find(target_nodes_.begin(), target_nodes_.end(), node);
    if (found != target_nodes_.end()) return static_cast<std::size_t>(found - target_nodes_.begin());
    target_nodes_.push_back(node);
    local_.resize(local_.size() + 4, 0.0);
    return target_nodes_.size() - 1;
  };
  std::array<double, 16> mass{};
  for (const auto& point : points_) {
    const auto nodes = target_.face(point.target_face);
    const auto ns = shape_values(n, point.source_xi), nt = shape_values(nodes.size(), point.target_xi);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) mass[4 * a + b] += point.weight * ns[a] * ns[b];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto column = column_of(nodes[k]);
      for (std::size_t a = 0; a < n; ++a) local_[4 * column + a] += point.weight * nt[k] * ns[a];
    }
    if (target_mass_.empty()) continue;
    auto& sum = target_mass_[static_cast<std::size_t>(point.target_face)];
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = 0; b < nodes.size(); ++b) sum[4 * a + b] += point.weight * nt[a] * nt[b];
  }
  // A face that is covered by so little that no weights keep the first moments still keeps its force.
  const auto own = shape_integrals(source_, face);
  if (metric_ == Metric::source)
    for (std::size_t a = 0; a < n; ++a) {
      double covered = 0.0;
      for (std::size_t column = 0; column < target_nodes_.size(); ++column) covered += local_[4 * column + a];
      const double factor = covered > 0.0 ? own[static_cast<Eigen::Index>(a)] / covered : 1.0;
      for (std::size_t column = 0; column < target_nodes_.size(); ++column) local_[4 * column + a] *= factor;
    }
  for (std::size_t column = 0; column < target_nodes_.size(); ++column) {
    double whole = 0.0; // the source's shape functions sum to one
    for (std::size_t a = 0; a < n; ++a) {
      nodal_.push_back({target_nodes_[column], source_nodes[a], local_[4 * column + a]});
      whole += local_[4 * column + a];
    }
    if (location_ == Location::faces) facial_.push_back({target_nodes_[column], face, whole});
  }
  if (mass_ != MassMetric::same || !has_source_mass_) return;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) source_mass_.push_back({source_nodes[a], source_nodes[b], mass[4 * a + b]});
}

TransferOperators OverlayAssembly::finish(const FaceTree& target_tree)
{
  if (!pieces_.empty()) integrate_face();
  attach_uncovered(target_tree);
  const auto taken = [](std::vector<Entry>& entries, std::int64_t n_rows, std::int64_t n_columns) {
    auto matrix = assembled(n_rows, n_columns, entries);
    std::vector<Entry>().swap(entries); // there may be a hundred million
    return matrix;
  };
  TransferOperators result;
  result.source_location = location_;
  result.nodal_load = taken(nodal_, target_.n_nodes(), source_.n_nodes());
  result.load = location_ == Location::nodes ? result.nodal_load : taken(facial_, target_.n_nodes(), source_.n_faces());
  if (mass_ == MassMetric::same) {
    if (has_source_mass_) result.source_mass = mass_matrix(taken(source_mass_, source_.n_nodes(), source_.n_nodes()));
    std::vector<Entry> entries;
    for (std::int32_t face = 0; face < target_.n_faces(); ++face) {
      const auto nodes = target_.face(face);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = 0; b < nodes.size(); ++b)
          entries.push_back({nodes[a], nodes[b], target_mass_[static_cast<std::size_t>(face)][4 * a + b]});
    }
    target_mass_.clear();
    target_mass_.shrink_to_fit();
    result.target_mass = mass_matrix(taken(entries, target_.n_nodes(), target_.n_nodes()));
  } else {
    if (has_source_mass_) result.source_mass = mass_matrix(native_mass(source_));
    result.target_mass = mass_matrix(native_mass(target_));
  }
  result.projection = node_projection(source_, target_, target_tree);
  return result;
}

} // namespace mullion::surface
