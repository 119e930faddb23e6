#include "rigid_link.hpp"

#include "shape_functions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace mullion::surface {

namespace {

Point in_space(const FieldView& field, Eigen::Index entity)
{
  Point p = Point::Zero();
  for (Eigen::Index c = 0; c < std::min<Eigen::Index>(field.rows(), 3); ++c) p[c] = field(c, entity);
  return p;
}

void add_to(Field& field, Eigen::Index entity, const Point& value)
{
  for (Eigen::Index c = 0; c < std::min<Eigen::Index>(field.rows(), 3); ++c) field(c, entity) += value[c];
}

/// Derivatives of the shape functions at the middle of a face, along xi and eta.
std::vector<std::array<double, 2>> slopes(std::size_t n_nodes)
{
  if (n_nodes == 2) return {{-1.0, 0.0}, {1.0, 0.0}};
  if (n_nodes == 3) return {{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}};
  return {{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}};
}

} // namespace

RigidLink::RigidLink(const SurfaceMesh& target, Operator arm_x, Operator arm_y, Operator arm_z)
    : rotations_(static_cast<std::size_t>(target.n_faces())), arm_{std::move(arm_x), std::move(arm_y), std::move(arm_z)}
{
  const double middle[2] = {0.5, 0.5}; // a triangle's tangents are the same everywhere
  for (std::int64_t f = 0; f < target.n_faces(); ++f) {
    auto& rotation = rotations_[static_cast<std::size_t>(f)];
    const auto nodes = target.face(f);
    const auto t = tangents(target, f, middle);
    // Dual tangents: a_i . a^j = 1 if i = j, else 0. Of a line the second one is along the third axis.
    const Point second = nodes.size() == 2 ? Point::UnitZ() : t.eta;
    const Point cross = t.xi.cross(second);
    const double square = cross.squaredNorm();
    rotation.normal = Point::Zero();
    for (auto& b : rotation.b) b = Point::Zero();
    if (!(square > 0.0)) continue; // without measure: no points, no arms
    rotation.normal = cross / std::sqrt(square);
    const Point dual_xi = second.cross(cross) / square, dual_eta = cross.cross(t.xi) / square;
    const auto slope = slopes(nodes.size());
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      rotation.nodes[k] = nodes[k];
      rotation.b[k] = rotation.normal.cross(slope[k][0] * dual_xi + slope[k][1] * dual_eta);
    }
  }
}

void RigidLink::add_loads(const FieldView& traction, Field& loads) const
{
  for (Eigen::Index f = 0; f < static_cast<Eigen::Index>(rotations_.size()); ++f) {
    Point moment = Point::Zero();
    Operator::InnerIterator x(arm_[0], f), y(arm_[1], f), z(arm_[2], f); // the same columns in all three
    for (; x; ++x, ++y, ++z) moment += Point(x.value(), y.value(), z.value()).cross(in_space(traction, x.col()));
    const auto& [nodes, n, b] = rotations_[static_cast<std::size_t>(f)];
    for (std::size_t k = 0; k < 4 && nodes[k] >= 0; ++k)
      add_to(loads, nodes[k], 0.5 * n.dot(moment) * b[k] - b[k].dot(moment) * n);
  }
}

void RigidLink::add_motion(const FieldView& target_motion, Field& motion) const
{
  for (Eigen::Index f = 0; f < static_cast<Eigen::Index>(rotations_.size()); ++f) {
    const auto& [nodes, n, b] = rotations_[static_cast<std::size_t>(f)];
    Point turn = Point::Zero();
    for (std::size_t k = 0; k < 4 && nodes[k] >= 0; ++k) {
      const Point u = in_space(target_motion, nodes[k]);
      turn += 0.5 * b[k].dot(u) * n - n.dot(u) * b[k];
    }
    Operator::InnerIterator x(arm_[0], f), y(arm_[1], f), z(arm_[2], f);
    for (; x; ++x, ++y, ++z) add_to(motion, x.col(), turn.cross(Point(x.value(), y.value(), z.value())));
  }
}

RigidLinkSum::RigidLinkSum(std::int64_t n_target_faces, std::int64_t n_source_entities)
    : x_(n_target_faces, n_source_entities), y_(n_target_faces, n_source_entities),
      z_(n_target_faces, n_source_entities)
{
}

void RigidLinkSum::add(std::int32_t target_face, std::int32_t source_entity, const Point& arm)
{
  x_.add(target_face, source_entity, arm.x());
  y_.add(target_face, source_entity, arm.y());
  z_.add(target_face, source_entity, arm.z());
}

RigidLink RigidLinkSum::finish(const SurfaceMesh& target) { return {target, x_.finish(), y_.finish(), z_.finish()}; }

RigidLink link_of_forces(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                         const Operator& projection, const Operator& forces)
{
  RigidLinkSum sum(target.n_faces(), forces.cols());
  for (Eigen::Index i = 0; i < projection.rows(); ++i) {
    const Point x = node_position(source, i);
    Point arm = x;
    for (Operator::InnerIterator p(projection, i); p; ++p) arm -= p.value() * node_position(target, p.col());
    const auto face = target_tree.closest(x).face;
    for (Operator::InnerIterator m(forces, i); m; ++m)
      sum.add(face, static_cast<std::int32_t>(m.col()), m.value() * arm);
  }
  return sum.finish(target);
}

RigidLink link_of_nodes(const SurfaceMesh& source, const SurfaceMesh& target, const FaceTree& target_tree,
                        const Operator& projection)
{
  Operator forces(source.n_nodes(), source.n_nodes());
  forces.setIdentity();
  return link_of_forces(source, target, target_tree, projection, forces);
}

} // namespace mullion::surface
