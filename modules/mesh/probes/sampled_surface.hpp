// A surface on which given functions are sampled and received fields are measured: what a probe of a transfer computes.
// Everything is in the reference configuration; sums go face by face in the mesh's order, so they have the same bits
// each time.
#pragma once

#include "surface/operators.hpp"
#include "surface/surface_mesh.hpp"

#include <Eigen/Core>

#include <functional>

namespace mullion::probes {

using surface::Field; ///< (components x entities), one entity a column
using surface::FieldView;

/// A vector at a place with a unit normal, both of the space's dimension.
using SurfaceFunction = std::function<Eigen::VectorXd(const Eigen::VectorXd& x, const Eigen::VectorXd& normal)>;

struct SampledSurface {
  surface::SurfaceMesh mesh;
  double sign = 1.0;       ///< -1: normals are against those of the elements
  Eigen::VectorXd weights; ///< of the nodes: integral of N_i [m or m^2]
  Field nodal_normals;     ///< unit vectors along the integral of N_i n
};

/// @pre complaint_about(mesh) has none
[[nodiscard]] SampledSurface sampled(surface::SurfaceMesh mesh, bool is_reversed);

/// f at the centres of the faces, with their normals.
[[nodiscard]] Field on_faces(const SampledSurface& s, const SurfaceFunction& f);

/// f at the nodes, with the nodal normals.
[[nodiscard]] Field on_nodes(const SampledSurface& s, const SurfaceFunction& f);

/// R_i = integral of N_i f, by 4 Gauss points a direction: exact on plane faces for f of degree 5 (6 with N_i).
///
/// The normals are those of the surface at the points, not the nodal ones.
[[nodiscard]] Field loads_of(const SampledSurface& s, const SurfaceFunction& f);

/// Integral of t . v, where v is linear between nodes, and t linear or constant in each face.
[[nodiscard]] double power_of_traction(const SampledSurface& s, const FieldView& traction, surface::Location location,
                                       const FieldView& motion);

/// Size of a nodal field.
struct NodalNorms {
  double l2 = 0.0;  ///< sqrt(sum_i w_i |f_i|^2 / sum_i w_i)
  double max = 0.0; ///< of |f_i|
};

/// @param values  (components x nodes)
[[nodiscard]] NodalNorms norms_of(const SampledSurface& s, const FieldView& values);

/// Norms of the difference, each relative to that of what is expected; where that is 0 everywhere, absolute.
[[nodiscard]] NodalNorms relative_error(const SampledSurface& s, const FieldView& received, const FieldView& expected);

/// Nodal loads as a traction: R_i / w_i.
[[nodiscard]] Field per_weight(const SampledSurface& s, const FieldView& loads);

} // namespace mullion::probes
