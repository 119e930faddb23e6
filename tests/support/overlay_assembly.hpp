// Matrices from an overlay, as plainly as can be: what the tests of the overlay need to see that it is good for a
// transfer. The operators of the transfer modules are assembled elsewhere.
#pragma once

#include "surface/shape_functions.hpp"
#include "surface/surface_overlay.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <array>
#include <cstdint>
#include <vector>

namespace mullion::testing {

using Sparse = Eigen::SparseMatrix<double>;

/// Integrals over the overlay in the source's metric, each source face scaled to its own area.
struct OverlayMatrices {
  Sparse nodal;                             ///< B: (target nodes x source nodes), integral of N_s N_f [m^2]
  Sparse facial;                            ///< (target nodes x source faces), integral of N_s [m^2]
  Sparse target_mass;                       ///< integral of N_s N_s^T [m^2]
  Sparse source_mass;                       ///< integral of N_f N_f^T [m^2]
  Eigen::VectorXd source_area, target_area; ///< of each face, from the pieces in the own metric, unscaled [m^2]
  std::int64_t n_pieces = 0;
  bool is_finite_and_inside = true; ///< all local coordinates are finite and in the face, up to 1e-12
  bool is_ordered = true;           ///< source faces ascend, target faces within them
  surface::OverlayReport report;
};

/// Points and weights (barycentric coordinates; weights sum to one) exact for polynomials of degree 4 on a triangle:
/// enough for products of bilinear shape functions where those are polynomials in space. Dunavant 1985.
struct TrianglePoint {
  double b[3], weight;
};
inline constexpr std::array<TrianglePoint, 6> triangle_points = {{
    {{0.108103018168070, 0.445948490915965, 0.445948490915965}, 0.223381589678011},
    {{0.445948490915965, 0.108103018168070, 0.445948490915965}, 0.223381589678011},
    {{0.445948490915965, 0.445948490915965, 0.108103018168070}, 0.223381589678011},
    {{0.816847572980459, 0.091576213509771, 0.091576213509771}, 0.109951743655322},
    {{0.091576213509771, 0.816847572980459, 0.091576213509771}, 0.109951743655322},
    {{0.091576213509771, 0.091576213509771, 0.816847572980459}, 0.109951743655322},
}};

inline double polygon_area(const surface::SurfaceMesh& mesh, std::int32_t face, const double (*xi)[2], int n)
{
  const auto origin = surface::map_to_space(mesh, face, xi[0]);
  double twice = 0.0; // triangle by triangle: on a warped quadrilateral the vertices are in no plane
  for (int k = 1; k + 1 < n; ++k)
    twice += (surface::map_to_space(mesh, face, xi[k]) - origin)
                 .cross(surface::map_to_space(mesh, face, xi[k + 1]) - origin)
                 .norm();
  return 0.5 * twice;
}

/// Local coordinates of the weighted mean of three vertices of a piece. In a quadrilateral the mean of the places is
/// not at the mean of the local coordinates.
inline void local_of_mean(const surface::SurfaceMesh& mesh, std::int32_t face, const double (&corner_xi)[3][2],
                          const double (&weights)[3], double (&local)[2])
{
  local[0] = local[1] = 0.0;
  surface::Point x = surface::Point::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t c = 0; c < 2; ++c) local[c] += weights[k] * corner_xi[k][c];
    x += weights[k] * surface::map_to_space(mesh, face, corner_xi[k]);
  }
  if (mesh.face(face).size() == 4) surface::invert_quadrilateral(mesh, face, x, local);
}

inline OverlayMatrices assemble(const surface::SurfaceMesh& source, const surface::SurfaceMesh& target,
                                const surface::SurfaceOverlayOptions& options = {})
{
  using surface::Subelement;
  OverlayMatrices m;
  m.source_area = Eigen::VectorXd::Zero(source.n_faces());
  m.target_area = Eigen::VectorXd::Zero(target.n_faces());
  std::vector<Subelement> pieces;
  std::int32_t last_source = -1, last_target = -1;
  m.report = overlay_surfaces(source, target, options, [&](const Subelement& piece) {
    m.is_ordered = m.is_ordered && piece.source_face >= last_source &&
                   (piece.source_face > last_source || piece.target_face >= last_target);
    last_source = piece.source_face;
    last_target = piece.target_face;
    pieces.push_back(piece);
    m.source_area[piece.source_face] += polygon_area(source, piece.source_face, piece.source_xi, piece.n_vertices);
    m.target_area[piece.target_face] += polygon_area(target, piece.target_face, piece.target_xi, piece.n_vertices);
  });
  m.n_pieces = static_cast<std::int64_t>(pieces.size());

  const auto is_inside = [](const surface::SurfaceMesh& mesh, std::int32_t face, const double* xi) {
    const double most = mesh.face(face).size() == 3 ? 1.0 - xi[0] : 1.0;
    return xi[0] >= -1e-12 && xi[0] <= 1.0 + 1e-12 && xi[1] >= -1e-12 && xi[1] <= most + 1e-12;
  };
  std::vector<Eigen::Triplet<double>> nodal, facial, target_mass, source_mass;
  for (const auto& piece : pieces) {
    const auto source_nodes = source.face(piece.source_face), target_nodes = target.face(piece.target_face);
    const double scale = face_measure(source, piece.source_face) / m.source_area[piece.source_face];
    for (int k = 0; k < piece.n_vertices; ++k)
      m.is_finite_and_inside = m.is_finite_and_inside && is_inside(source, piece.source_face, piece.source_xi[k]) &&
                               is_inside(target, piece.target_face, piece.target_xi[k]);
    Eigen::Matrix4d sf = Eigen::Matrix4d::Zero(), ss = sf, ff = sf; // integrals over the piece, (target x source) first
    Eigen::Vector4d s = Eigen::Vector4d::Zero();
    for (int k = 1; k + 1 < piece.n_vertices; ++k) {
      double in_source[3][2], in_target[3][2];
      for (int corner = 0; corner < 3; ++corner)
        for (int c = 0; c < 2; ++c) {
          const int vertex = corner == 0 ? 0 : k + corner - 1;
          in_source[corner][c] = piece.source_xi[vertex][c];
          in_target[corner][c] = piece.target_xi[vertex][c];
        }
      const double area = scale * polygon_area(source, piece.source_face, in_source, 3);
      for (const auto& point : triangle_points) {
        double source_xi[2], target_xi[2];
        local_of_mean(source, piece.source_face, in_source, point.b, source_xi);
        local_of_mean(target, piece.target_face, in_target, point.b, target_xi);
        const auto f_values = surface::shape_values(source_nodes.size(), source_xi);
        const auto s_values = surface::shape_values(target_nodes.size(), target_xi);
        const Eigen::Vector4d n_f = Eigen::Vector4d::Map(f_values.data()), n_s = Eigen::Vector4d::Map(s_values.data());
        const double w = area * point.weight;
        sf += w * n_s * n_f.transpose();
        ss += w * n_s * n_s.transpose();
        ff += w * n_f * n_f.transpose();
        s += w * n_s;
      }
    }
    const auto add = [](auto& entries, auto rows, auto columns, const Eigen::Matrix4d& values) {
      for (std::size_t j = 0; j < rows.size(); ++j)
        for (std::size_t i = 0; i < columns.size(); ++i)
          entries.emplace_back(rows[j], columns[i], values(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(i)));
    };
    add(nodal, target_nodes, source_nodes, sf);
    add(target_mass, target_nodes, target_nodes, ss);
    add(source_mass, source_nodes, source_nodes, ff);
    for (std::size_t j = 0; j < target_nodes.size(); ++j)
      facial.emplace_back(target_nodes[j], piece.source_face, s[static_cast<Eigen::Index>(j)]);
  }
  const auto n_s = target.n_nodes(), n_f = source.n_nodes();
  const auto fill = [](Sparse& matrix, std::int64_t rows, std::int64_t columns, const auto& entries) {
    matrix.resize(rows, columns);
    matrix.setFromTriplets(entries.begin(), entries.end());
  };
  fill(m.nodal, n_s, n_f, nodal);
  fill(m.facial, n_s, source.n_faces(), facial);
  fill(m.target_mass, n_s, n_s, target_mass);
  fill(m.source_mass, n_f, n_f, source_mass);
  return m;
}

/// The least-squares field of a load vector: M t = R, in the metric of the overlay.
/// @pre every target node is reached
inline Eigen::VectorXd recovered(const OverlayMatrices& m, const Eigen::VectorXd& load)
{
  return Eigen::SimplicialLDLT<Sparse>(m.target_mass).solve(load);
}

} // namespace mullion::testing
