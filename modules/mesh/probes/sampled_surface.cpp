#include "sampled_surface.hpp"

#include "surface/quadrature_rules.hpp"
#include "surface/shape_functions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mullion::probes {
namespace {

using surface::Point;

/// Normal times the measure's density at a place of a face, against the elements' sense if so asked for.
Point directed_density(const SampledSurface& s, std::int64_t f, const double* xi)
{
  const auto [t, e] = surface::tangents(s.mesh, f, xi);
  return s.sign * (s.mesh.dimension == 2 ? t.cross(Point::UnitZ()) : t.cross(e));
}

/// Call visit(face, point of the rule, shape functions) for n points a direction on all faces.
template <class Visit> void for_each_point(const SampledSurface& s, int n, const Visit& visit)
{
  const surface::Rule rules[] = {surface::face_rule(2, n), surface::face_rule(3, n), surface::face_rule(4, n)};
  for (std::int64_t f = 0; f < s.mesh.n_faces(); ++f) {
    const auto n_nodes = s.mesh.face(f).size();
    for (const auto& point : rules[n_nodes - 2]) visit(f, point, surface::shape_values(n_nodes, point.xi));
  }
}

constexpr int n_points = 4; // a direction

} // namespace

SampledSurface sampled(surface::SurfaceMesh mesh, bool is_reversed)
{
  SampledSurface s{std::move(mesh), is_reversed ? -1.0 : 1.0, {}, {}};
  s.weights = Eigen::VectorXd::Zero(s.mesh.n_nodes());
  s.nodal_normals = Field::Zero(s.mesh.dimension, s.mesh.n_nodes());
  for_each_point(s, n_points, [&](std::int64_t f, const surface::RulePoint& point, const surface::ShapeValues& shape) {
    const Point normal = point.weight * directed_density(s, f, point.xi);
    const auto nodes = s.mesh.face(f);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      s.weights[nodes[k]] += shape[k] * normal.norm();
      s.nodal_normals.col(nodes[k]) += shape[k] * normal.head(s.mesh.dimension);
    }
  });
  for (auto normal : s.nodal_normals.colwise())
    if (normal.norm() > 0.0) normal.normalize(); // 0 where faces lie back to back: no direction
  return s;
}

Field on_faces(const SampledSurface& s, const SurfaceFunction& f)
{
  Field values(s.mesh.dimension, s.mesh.n_faces());
  for (std::int64_t face = 0; face < s.mesh.n_faces(); ++face)
    values.col(face) = f(surface::face_centre(s.mesh, face).head(s.mesh.dimension),
                         s.sign * surface::face_normal(s.mesh, face).head(s.mesh.dimension));
  return values;
}

Field on_nodes(const SampledSurface& s, const SurfaceFunction& f)
{
  Field values(s.mesh.dimension, s.mesh.n_nodes());
  for (std::int64_t i = 0; i < s.mesh.n_nodes(); ++i) values.col(i) = f(s.mesh.nodes.col(i), s.nodal_normals.col(i));
  return values;
}

Field loads_of(const SampledSurface& s, const SurfaceFunction& f)
{
  Field loads = Field::Zero(s.mesh.dimension, s.mesh.n_nodes());
  for_each_point(s, n_points,
                 [&](std::int64_t face, const surface::RulePoint& point, const surface::ShapeValues& shape) {
                   const Point directed = directed_density(s, face, point.xi);
                   const double density = directed.norm();
                   if (density == 0.0) return; // a collapsed corner has no area
                   const Eigen::VectorXd value = f(surface::map_to_space(s.mesh, face, point.xi).head(s.mesh.dimension),
                                                   (directed / density).head(s.mesh.dimension));
                   const auto nodes = s.mesh.face(face);
                   for (std::size_t k = 0; k < nodes.size(); ++k)
                     loads.col(nodes[k]) += point.weight * density * shape[k] * value;
                 });
  return loads;
}

double power_of_traction(const SampledSurface& s, const FieldView& traction, surface::Location location,
                         const FieldView& motion)
{
  double power = 0.0;
  for_each_point(s, n_points, [&](std::int64_t f, const surface::RulePoint& point, const surface::ShapeValues& shape) {
    const auto nodes = s.mesh.face(f);
    Eigen::VectorXd t = Eigen::VectorXd::Zero(s.mesh.dimension), v = t;
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      if (location == surface::Location::nodes) t += shape[k] * traction.col(nodes[k]);
      v += shape[k] * motion.col(nodes[k]);
    }
    if (location == surface::Location::faces) t = traction.col(f);
    power += point.weight * directed_density(s, f, point.xi).norm() * t.dot(v);
  });
  return power;
}

NodalNorms norms_of(const SampledSurface& s, const FieldView& values)
{
  double squares = 0.0, area = 0.0, largest = 0.0;
  for (Eigen::Index i = 0; i < values.cols(); ++i) {
    const double square = values.col(i).squaredNorm();
    squares += s.weights[i] * square;
    area += s.weights[i];
    largest = std::max(largest, square);
  }
  return {area > 0.0 ? std::sqrt(squares / area) : 0.0, std::sqrt(largest)}; // no area: nothing to be off
}

NodalNorms relative_error(const SampledSurface& s, const FieldView& received, const FieldView& expected)
{
  auto error = norms_of(s, received - expected);
  const auto scale = norms_of(s, expected);
  if (scale.l2 > 0.0) error.l2 /= scale.l2;
  if (scale.max > 0.0) error.max /= scale.max;
  return error;
}

Field per_weight(const SampledSurface& s, const FieldView& loads)
{
  Field traction = loads;
  for (Eigen::Index i = 0; i < loads.cols(); ++i)
    if (s.weights[i] > 0.0) traction.col(i) /= s.weights[i];
    else traction.col(i).setZero(); // a node of degenerate faces only
  return traction;
}

} // namespace mullion::probes
