#include "boundary.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace mullion::elastic_solid {
namespace {

Shape face_shape(std::size_t n_nodes)
{
  return n_nodes == 2 ? Shape::line2 : n_nodes == 3 ? Shape::triangle3 : Shape::quadrilateral4;
}

Eigen::MatrixXd columns(const Eigen::MatrixXd& all, const Eigen::VectorX<Index>& which)
{
  Eigen::MatrixXd out(all.rows(), which.size());
  for (Eigen::Index a = 0; a < which.size(); ++a) out.col(a) = all.col(which[a]);
  return out;
}

/// n dA at a point of a face, outward.
Eigen::VectorXd area_vector(const Eigen::MatrixXd& nodes, const Eigen::MatrixXd& gradients)
{
  const Eigen::MatrixXd tangents = nodes * gradients;
  if (nodes.rows() == 2) return Eigen::Vector2d(tangents(1, 0), -tangents(0, 0));
  return Eigen::Vector3d(tangents.col(0)).cross(Eigen::Vector3d(tangents.col(1)));
}

} // namespace

const std::vector<std::vector<int>>& local_faces(Shape shape)
{
  static const std::array<std::vector<std::vector<int>>, mesh_files::n_shapes> tables = [] {
    std::array<std::vector<std::vector<int>>, mesh_files::n_shapes> all;
    all[static_cast<std::size_t>(Shape::triangle3)] = {{0, 1}, {1, 2}, {2, 0}};
    all[static_cast<std::size_t>(Shape::quadrilateral4)] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    all[static_cast<std::size_t>(Shape::tetrahedron4)] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    all[static_cast<std::size_t>(Shape::hexahedron8)] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    return all;
  }();
  return tables[static_cast<std::size_t>(shape)];
}

Surface surface_of(const Solid& solid, const std::vector<FaceOf>& owners)
{
  std::vector<std::vector<int>> wanted(static_cast<std::size_t>(n_elements(solid)));
  for (const auto& owner : owners) wanted[static_cast<std::size_t>(owner.element)].push_back(owner.local);
  Surface surface;
  for_each_element(solid, [&](Eigen::Index e, Shape shape, const Eigen::VectorX<Index>& nodes) {
    auto& locals = wanted[static_cast<std::size_t>(e)];
    std::sort(locals.begin(), locals.end());
    for (const int local : locals) {
      const auto& corners = local_faces(shape)[static_cast<std::size_t>(local)];
      Eigen::VectorX<Index> face(static_cast<Eigen::Index>(corners.size()));
      for (std::size_t a = 0; a < corners.size(); ++a) face[static_cast<Eigen::Index>(a)] = nodes[corners[a]];
      surface.shapes.push_back(face_shape(corners.size()));
      surface.faces.push_back(face);
      surface.owners.push_back({e, local});
    }
  });
  return surface;
}

Surface surface_of_blocks(const std::vector<mesh_files::Block>& blocks)
{
  Surface surface;
  for (const auto& block : blocks)
    for (Eigen::Index f = 0; f < block.connectivity.cols(); ++f) {
      surface.shapes.push_back(block.shape);
      surface.faces.emplace_back(block.connectivity.col(f));
    }
  return surface;
}

std::vector<FaceOf> boundary_faces(const Solid& solid)
{
  std::map<std::vector<Index>, int> count; // of elements, by the sorted nodes of a face
  const auto each_face = [&](const auto& f) {
    for_each_element(solid, [&](Eigen::Index e, Shape shape, const Eigen::VectorX<Index>& nodes) {
      const auto& faces = local_faces(shape);
      for (std::size_t k = 0; k < faces.size(); ++k) {
        std::vector<Index> key;
        for (const int a : faces[k]) key.push_back(nodes[a]);
        std::sort(key.begin(), key.end());
        f(FaceOf{e, static_cast<int>(k)}, key);
      }
    });
  };
  each_face([&](const FaceOf&, const std::vector<Index>& key) { ++count[key]; });
  std::vector<FaceOf> out;
  each_face([&](const FaceOf& face, const std::vector<Index>& key) {
    if (count[key] == 1) out.push_back(face);
  });
  return out;
}

std::vector<Index> nodes_of(const Surface& surface)
{
  std::vector<Index> nodes;
  for (const auto& face : surface.faces) nodes.insert(nodes.end(), face.begin(), face.end());
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

SparseMatrix surface_mass(const Eigen::MatrixXd& nodes, const Surface& surface)
{
  std::vector<Eigen::Triplet<double>> triplets;
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto& face = surface.faces[f];
    const auto x = columns(nodes, face);
    Eigen::MatrixXd s = Eigen::MatrixXd::Zero(face.size(), face.size());
    for (const auto& point : quadrature(surface.shapes[f])) {
      const auto n = shape_values(surface.shapes[f], point.xi);
      s += (point.weight * area_vector(x, n.gradients).norm()) * n.values * n.values.transpose();
    }
    for (Eigen::Index b = 0; b < face.size(); ++b)
      for (Eigen::Index a = 0; a < face.size(); ++a) triplets.emplace_back(face[a], face[b], s(a, b));
  }
  SparseMatrix matrix(nodes.cols(), nodes.cols());
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

Eigen::MatrixXd nodal_normals(const Eigen::MatrixXd& nodes, const Surface& surface)
{
  Eigen::MatrixXd normals = Eigen::MatrixXd::Zero(nodes.rows(), nodes.cols());
  for (std::size_t f = 0; f < surface.faces.size(); ++f) {
    const auto& face = surface.faces[f];
    const auto x = columns(nodes, face);
    for (const auto& point : quadrature(surface.shapes[f])) {
      const auto n = shape_values(surface.shapes[f], point.xi);
      const Eigen::VectorXd area = point.weight * area_vector(x, n.gradients);
      for (Eigen::Index a = 0; a < face.size(); ++a) normals.col(face[a]) += n.values[a] * area;
    }
  }
  return normals;
}

} // namespace mullion::elastic_solid
