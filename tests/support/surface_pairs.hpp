// Pairs of surface meshes for the tests of the transfers: polylines along a curve, and everything that a transfer from
// one to the other needs, built at once.
#pragma once

#include "surface/integration_points.hpp"
#include "surface/mass_matrix.hpp"
#include "surface/operators.hpp"
#include "surface/polyline_overlay.hpp"
#include "surface/subelement.hpp"
#include "surface/surface_mesh.hpp"

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <utility>
#include <vector>

namespace mullion::testing {

/// A place on a curve for a parameter in [0, 1].
using Curve = std::function<Eigen::Vector2d(double)>;

inline Eigen::Vector2d flat(double s) { return {s, 0.0}; }

/// A quarter of the unit circle.
inline Eigen::Vector2d arc(double s)
{
  return {std::cos(0.5 * std::numbers::pi * s), std::sin(0.5 * std::numbers::pi * s)};
}

/// Faces between the given nodes in their order; a loop returns to the first.
inline surface::SurfaceMesh polyline(const std::vector<Eigen::Vector2d>& x, bool is_loop = false)
{
  surface::SurfaceMesh mesh;
  mesh.dimension = 2;
  mesh.nodes.resize(2, static_cast<Eigen::Index>(x.size()));
  for (std::size_t i = 0; i < x.size(); ++i) mesh.nodes.col(static_cast<Eigen::Index>(i)) = x[i];
  mesh.face_begin = {0};
  const std::size_t n_faces = is_loop ? x.size() : x.size() - 1;
  for (std::size_t f = 0; f < n_faces; ++f) {
    mesh.face_nodes.push_back(static_cast<std::int32_t>(f));
    mesh.face_nodes.push_back(static_cast<std::int32_t>((f + 1) % x.size()));
    mesh.face_begin.push_back(static_cast<std::int32_t>(mesh.face_nodes.size()));
  }
  return mesh;
}

/// n faces with nodes at equal parameters of the curve.
inline surface::SurfaceMesh along(const Curve& curve, int n)
{
  std::vector<Eigen::Vector2d> x;
  for (int i = 0; i <= n; ++i) x.push_back(curve(static_cast<double>(i) / n));
  return polyline(x);
}

/// The same surface walked the other way: faces, their nodes and the numbers of both are reversed.
inline surface::SurfaceMesh reversed(const surface::SurfaceMesh& mesh)
{
  surface::SurfaceMesh result = mesh;
  const auto n = static_cast<std::int32_t>(mesh.n_nodes());
  result.nodes = mesh.nodes.rowwise().reverse();
  for (std::size_t k = 0; k < mesh.face_nodes.size(); ++k)
    result.face_nodes[k] = n - 1 - mesh.face_nodes[mesh.face_nodes.size() - 1 - k];
  return result;
}

/// What overlay_polylines() delivers.
struct Overlay {
  std::vector<surface::Subelement> pieces;
  surface::OverlayReport report;
};

inline Overlay overlay(const surface::SurfaceMesh& source, const surface::SurfaceMesh& target,
                       const surface::PolylineOverlayOptions& options = {})
{
  Overlay result;
  result.report = surface::overlay_polylines(source, target, options,
                                             [&](const surface::Subelement& s) { result.pieces.push_back(s); });
  return result;
}

/// Points of the common refinement.
inline surface::PointSet refined(const surface::SurfaceMesh& source, const surface::SurfaceMesh& target,
                                 surface::Metric metric = surface::Metric::source)
{
  return surface::points_of_overlay(source, target, overlay(source, target).pieces, metric);
}

/// A field of one component from the places of a mesh's nodes.
inline surface::Field nodal_field(const surface::SurfaceMesh& mesh,
                                  const std::function<double(const surface::Point&)>& f)
{
  surface::Field field(1, mesh.n_nodes());
  for (std::int64_t i = 0; i < mesh.n_nodes(); ++i) field(0, i) = f(surface::node_position(mesh, i));
  return field;
}

/// sqrt(e M e) / sqrt(t M t): relative L2 norm of an error on a mesh.
inline double relative_l2(const surface::SurfaceMesh& mesh, const surface::Field& field, const surface::Field& exact)
{
  const surface::Operator mass = surface::native_mass(mesh);
  const surface::Field error = field - exact;
  const auto square = [&](const surface::Field& f) { return f.cwiseProduct(surface::apply(mass, f)).sum(); };
  return std::sqrt(square(error) / square(exact));
}

} // namespace mullion::testing
