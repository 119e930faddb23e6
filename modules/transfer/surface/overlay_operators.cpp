#include "overlay_operators.hpp"

#include "shape_functions.hpp"

#include <algorithm>
#include <array>

namespace mullion::surface {

OverlayAssembly::OverlayAssembly(const SurfaceMesh& source, const SurfaceMesh& target, Location source_location,
                                 Metric metric, MassMetric mass, SourceMass source_mass, Offsets offsets)
    : source_(source), target_(target), location_(source_location), metric_(metric), mass_(mass),
      has_source_mass_(source_mass == SourceMass::factorised), nodal_(target.n_nodes(), source.n_nodes()),
      facial_(target.n_nodes(), source.n_faces()), source_mass_(source.n_nodes(), source.n_nodes()),
      has_links_(offsets == Offsets::rigid_link), nodal_link_(target.n_faces(), source.n_nodes()),
      facial_link_(target.n_faces(), source.n_faces()), is_covered_(static_cast<std::size_t>(source.n_faces()), false)
{
  if (mass != MassMetric::same) return;
  target_mass_begin_.push_back(0);
  for (std::int64_t f = 0; f < target.n_faces(); ++f) {
    const auto n = static_cast<std::int64_t>(target.face(f).size());
    target_mass_begin_.push_back(target_mass_begin_.back() + n * (n + 1) / 2);
  }
  target_mass_.assign(static_cast<std::size_t>(target_mass_begin_.back()), 0.0);
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
  pieces_.clear();
  if (coverage > 0.0) add_points(face, points_);
}

void OverlayAssembly::attach_uncovered(const FaceTree& target_tree)
{
  constexpr int points_a_direction = 2;
  if (target_.n_faces() == 0) return;
  for (std::int32_t face = 0; face < source_.n_faces(); ++face) {
    if (is_covered_[static_cast<std::size_t>(face)] || !(face_measure(source_, face) > 0.0)) continue;
    points_.clear();
    if (add_closest_points(source_, target_tree, face, points_a_direction, points_)) add_points(face, points_);
  }
}

void OverlayAssembly::add_points(std::int32_t face, std::span<const IntegrationPoint> points)
{
  is_covered_[static_cast<std::size_t>(face)] = true;
  const auto source_nodes = source_.face(face);
  const std::size_t n = source_nodes.size();
  target_nodes_.clear(), local_.clear(), arms_.clear();

  // Few target nodes lie near a source face: a list is searched faster than anything cleverer.
  const auto column_of = [&](std::int32_t node) {
    const auto found = std::find(target_nodes_.begin(), target_nodes_.end(), node);
    if (found != target_nodes_.end()) return static_cast<std::size_t>(found - target_nodes_.begin());
    target_nodes_.push_back(node);
    local_.resize(local_.size() + 4, 0.0);
    return target_nodes_.size() - 1;
  };
  std::array<double, 16> mass{};
  for (const auto& point : points) {
    const auto nodes = target_.face(point.target_face);
    const auto ns = shape_values(n, point.source_xi), nt = shape_values(nodes.size(), point.target_xi);
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t b = 0; b < n; ++b) mass[4 * a + b] += point.weight * ns[a] * ns[b];
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      const auto column = column_of(nodes[k]);
      for (std::size_t a = 0; a < n; ++a) local_[4 * column + a] += point.weight * nt[k] * ns[a];
    }
    if (has_links_) {
      const Point arm =
          map_to_space(source_, face, point.source_xi) - map_to_space(target_, point.target_face, point.target_xi);
      for (std::size_t a = 0; a < n; ++a) arms_.emplace_back(point.target_face, point.weight * ns[a] * arm);
    }
    if (target_mass_.empty()) continue;
    auto* sum =
        &target_mass_[static_cast<std::size_t>(target_mass_begin_[static_cast<std::size_t>(point.target_face)])];
    for (std::size_t a = 0; a < nodes.size(); ++a)
      for (std::size_t b = a; b < nodes.size(); ++b) *sum++ += point.weight * nt[a] * nt[b];
  }
  // A face that is covered by so little that no weights keep the first moments still keeps its force.
  const auto own = shape_integrals(source_, face);
  std::array<double, 4> factors = {1.0, 1.0, 1.0, 1.0};
  if (metric_ == Metric::source)
    for (std::size_t a = 0; a < n; ++a) {
      double covered = 0.0;
      for (std::size_t column = 0; column < target_nodes_.size(); ++column) covered += local_[4 * column + a];
      const double factor = covered > 0.0 ? own[static_cast<Eigen::Index>(a)] / covered : 1.0;
      for (std::size_t column = 0; column < target_nodes_.size(); ++column) local_[4 * column + a] *= factor;
      factors[a] = factor;
    }
  for (std::size_t k = 0; k < arms_.size(); ++k) {
    const auto& [target_face, arm] = arms_[k];
    nodal_link_.add(target_face, source_nodes[k % n], factors[k % n] * arm);
    if (location_ == Location::faces) facial_link_.add(target_face, face, factors[k % n] * arm);
  }
  for (std::size_t column = 0; column < target_nodes_.size(); ++column) {
    double whole = 0.0; // the source's shape functions sum to one
    for (std::size_t a = 0; a < n; ++a) {
      nodal_.add(target_nodes_[column], source_nodes[a], local_[4 * column + a]);
      whole += local_[4 * column + a];
    }
    if (location_ == Location::faces) facial_.add(target_nodes_[column], face, whole);
  }
  if (mass_ != MassMetric::same || !has_source_mass_) return;
  for (std::size_t a = 0; a < n; ++a)
    for (std::size_t b = 0; b < n; ++b) source_mass_.add(source_nodes[a], source_nodes[b], mass[4 * a + b]);
}

TransferOperators OverlayAssembly::finish(const FaceTree& target_tree)
{
  if (!pieces_.empty()) integrate_face();
  attach_uncovered(target_tree);
  TransferOperators result;
  result.source_location = location_;
  result.nodal_load = nodal_.finish();
  result.load = location_ == Location::nodes ? result.nodal_load : facial_.finish();
  if (mass_ == MassMetric::same) {
    if (has_source_mass_) result.source_mass = mass_matrix(source_mass_.finish());
    OperatorSum target_mass(target_.n_nodes(), target_.n_nodes());
    const double* sum = target_mass_.data();
    for (std::int32_t face = 0; face < target_.n_faces(); ++face) {
      const auto nodes = target_.face(face);
      for (std::size_t a = 0; a < nodes.size(); ++a)
        for (std::size_t b = a; b < nodes.size(); ++b, ++sum) {
          target_mass.add(nodes[a], nodes[b], *sum);
          if (b != a) target_mass.add(nodes[b], nodes[a], *sum);
        }
    }
    std::vector<double>().swap(target_mass_);
    result.target_mass = mass_matrix(target_mass.finish());
  } else {
    if (has_source_mass_) result.source_mass = mass_matrix(native_mass(source_));
    result.target_mass = mass_matrix(native_mass(target_));
  }
  result.projection = node_projection(source_, target_, target_tree);
  if (has_links_) {
    result.nodal_link = nodal_link_.finish(target_);
    result.load_link = location_ == Location::nodes ? result.nodal_link : facial_link_.finish(target_);
    result.motion_link = link_of_nodes(source_, target_, target_tree, result.projection);
  }
  return result;
}

} // namespace mullion::surface
