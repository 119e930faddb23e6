// The linear faces: line2 in 2D, triangle3 and quadrilateral4 in 3D. Values of their shape functions, their mapping
// into space, and its inverse. A face is known by its number of nodes, as in SurfaceMesh.
#pragma once

#include "surface_mesh.hpp"

#include <Eigen/Core>

#include <array>
#include <cmath>

namespace mullion::surface {

/// Shape functions of a face at one place; those beyond its number of nodes are zero.
using ShapeValues = std::array<double, 4>;

/// N_k(xi, eta). They sum to one.
///
///     line           1 - xi, xi
///     triangle       1 - xi - eta, xi, eta
///     quadrilateral  (1-xi)(1-eta), xi (1-eta), xi eta, (1-xi) eta
inline ShapeValues shape_values(std::size_t n_nodes, const double* xi)
{
  const double a = xi[0], b = xi[1];
  if (n_nodes == 2) return {1.0 - a, a, 0.0, 0.0};
  if (n_nodes == 3) return {1.0 - a - b, a, b, 0.0};
  return {(1.0 - a) * (1.0 - b), a * (1.0 - b), a * b, (1.0 - a) * b};
}

/// x(xi, eta) = sum_k N_k x_k [m].
inline Point map_to_space(const SurfaceMesh& mesh, std::int64_t f, const double* xi)
{
  const auto nodes = mesh.face(f);
  const auto n = shape_values(nodes.size(), xi);
  Point x = Point::Zero();
  for (std::size_t k = 0; k < nodes.size(); ++k) x += n[k] * node_position(mesh, nodes[k]);
  return x;
}

/// dx/dxi and dx/deta [m]; the second is zero for a line.
struct Tangents {
  Point xi, eta;
};

inline Tangents tangents(const SurfaceMesh& mesh, std::int64_t f, const double* xi)
{
  const auto nodes = mesh.face(f);
  const auto x = [&](std::size_t k) { return node_position(mesh, nodes[k]); };
  if (nodes.size() == 2) return {x(1) - x(0), Point::Zero()};
  if (nodes.size() == 3) return {x(1) - x(0), x(2) - x(0)};
  const double a = xi[0], b = xi[1];
  return {(1.0 - b) * (x(1) - x(0)) + b * (x(2) - x(3)), (1.0 - a) * (x(3) - x(0)) + a * (x(2) - x(1))};
}

/// Length or area per unit of the local coordinates [m or m^2]: |dx/dxi|, or |dx/dxi x dx/deta|.
inline double measure_density(const SurfaceMesh& mesh, std::int64_t f, const double* xi)
{
  const auto [t, s] = tangents(mesh, f, xi);
  return mesh.face(f).size() == 2 ? t.norm() : t.cross(s).norm();
}

/// Local coordinates of the point of a quadrilateral that lies closest to x, by Gauss-Newton on |x(xi, eta) - x|.
///
/// Exact in one step on a parallelogram; at most 20 steps elsewhere, each of which is bounded to one face width. Not
/// clamped to the face: a point outside has coordinates outside [0, 1].
///
/// @param xi  first guess in, result out
inline void invert_quadrilateral(const SurfaceMesh& mesh, std::int64_t f, const Point& x, double* xi)
{
  for (int iteration = 0; iteration < 20; ++iteration) {
    const Point r = x - map_to_space(mesh, f, xi);
    const auto [t, s] = tangents(mesh, f, xi);
    const double tt = t.dot(t), ts = t.dot(s), ss = s.dot(s);
    const double determinant = tt * ss - ts * ts;
    if (!(determinant > 1e-24 * tt * ss)) return; // a corner of 0 or 180 degrees: no direction to go
    const double rt = r.dot(t), rs = r.dot(s);
    double d_xi = (ss * rt - ts * rs) / determinant;
    double d_eta = (tt * rs - ts * rt) / determinant;
    const double length = std::max(std::abs(d_xi), std::abs(d_eta));
    if (length > 1.0) d_xi /= length, d_eta /= length;
    xi[0] += d_xi;
    xi[1] += d_eta;
    if (length < 1e-15) return;
  }
}

} // namespace mullion::surface
