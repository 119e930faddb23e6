// Formulas of faces and cells in two and three dimensions.
#include "geometry.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <cmath>

namespace mullion::euler {

namespace {

Eigen::Vector2d right_of(const Eigen::Vector2d& along) { return {along.y(), -along.x()}; }

/// Triangles of a face in space: itself, or four about the mean of its nodes.
template <class Function> void for_triangles(const FaceNodes<3>& face, const Nodes<3>& x, const Function& f)
{
  if (face[3] < 0) {
    f(x.col(face[0]), x.col(face[1]), x.col(face[2]));
    return;
  }
  const Eigen::Vector3d mean = 0.25 * (x.col(face[0]) + x.col(face[1]) + x.col(face[2]) + x.col(face[3]));
  for (std::size_t k = 0; k < 4; ++k) f(x.col(face[k]), x.col(face[(k + 1) % 4]), mean);
}

Eigen::Vector3d triangle_area(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
{
  return 0.5 * (b - a).cross(c - a);
}

} // namespace

template <> Vec<2> area_of<2>(const FaceNodes<2>& face, const Nodes<2>& x)
{
  return right_of(x.col(face[1]) - x.col(face[0]));
}

template <> Vec<3> area_of<3>(const FaceNodes<3>& face, const Nodes<3>& x)
{
  Vec<3> sum = Vec<3>::Zero();
  for_triangles(face, x, [&](const auto& a, const auto& b, const auto& c) { sum += triangle_area(a, b, c); });
  return sum;
}

template <> Sweep<2> sweep_of<2>(const FaceNodes<2>& face, const Nodes<2>& x, const Nodes<2>& v, double dt)
{
  const Vec<2> along = x.col(face[1]) - x.col(face[0]) + 0.5 * dt * (v.col(face[1]) - v.col(face[0]));
  Sweep<2> sweep;
  sweep.area = right_of(along);
  sweep.volume = dt * 0.5 * (v.col(face[0]) + v.col(face[1])).dot(sweep.area);
  return sweep;
}

template <> Sweep<3> sweep_of<3>(const FaceNodes<3>& face, const Nodes<3>& x, const Nodes<3>& v, double dt)
{
  Sweep<3> sweep;
  const auto add = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& va, const Eigen::Vector3d& vb, const Eigen::Vector3d& vc) {
    const auto at = [&](double t) -> Eigen::Vector3d { return triangle_area(a + t * va, b + t * vb, c + t * vc); };
    const Eigen::Vector3d area = (at(0.0) + 4.0 * at(0.5 * dt) + at(dt)) / 6.0;
    sweep.area += area;
    sweep.volume += dt * (va + vb + vc).dot(area) / 3.0;
  };
  if (face[3] < 0) {
    add(x.col(face[0]), x.col(face[1]), x.col(face[2]), v.col(face[0]), v.col(face[1]), v.col(face[2]));
    return sweep;
  }
  const Eigen::Vector3d x_mean = 0.25 * (x.col(face[0]) + x.col(face[1]) + x.col(face[2]) + x.col(face[3]));
  const Eigen::Vector3d v_mean = 0.25 * (v.col(face[0]) + v.col(face[1]) + v.col(face[2]) + v.col(face[3]));
  for (std::size_t k = 0; k < 4; ++k) {
    const Index i = face[k], j = face[(k + 1) % 4];
    add(x.col(i), x.col(j), x_mean, v.col(i), v.col(j), v_mean);
  }
  return sweep;
}

template <> Vec<2> middle_of<2>(const FaceNodes<2>& face, const Nodes<2>& x)
{
  return 0.5 * (x.col(face[0]) + x.col(face[1]));
}

template <> Vec<3> middle_of<3>(const FaceNodes<3>& face, const Nodes<3>& x)
{
  Vec<3> sum = Vec<3>::Zero();
  double area = 0.0;
  for_triangles(face, x, [&](const auto& a, const auto& b, const auto& c) {
    const double s = triangle_area(a, b, c).norm();
    sum += s * (a + b + c) / 3.0;
    area += s;
  });
  return sum / area;
}

template <int D> CellShape<D> cell_shape(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t cell)
{
  // Relative to a node of the cell, so that the place of the cell costs no digits. The parts of a periodic face of the
  // neighbour lie at the owner's side of the mesh and are brought here.
  CellShape<D> shape;
  Vec<D> origin = Vec<D>::Zero();
  const auto begin = mesh.cell_face_begin[cell];
  for (auto k = begin; k < mesh.cell_face_begin[cell + 1]; ++k) {
    const Index code = mesh.cell_faces[static_cast<std::size_t>(k)];
    const auto f = static_cast<std::size_t>(code / 2);
    const double sign = code % 2 == 0 ? 1.0 : -1.0;
    const auto& nodes = mesh.face_nodes[f];
    Vec<D> shift = Vec<D>::Zero();
    if (code % 2 == 1 && mesh.is_periodic()) shift = mesh.shifts[mesh.face_shift[f]]; // neighbour + shift: the owner's
    if (k == begin) origin = x.col(nodes[0]) - shift;
    if constexpr (D == 2) {
      const Vec<2> a = x.col(nodes[0]) - shift - origin, b = x.col(nodes[1]) - shift - origin;
      const double twice = sign * (a.x() * b.y() - a.y() * b.x());
      shape.volume += 0.5 * twice;
      shape.centroid += twice / 6.0 * (a + b);
    } else {
      for_triangles(nodes, x, [&](const Vec<3>& p, const Vec<3>& q, const Vec<3>& r) {
        const Vec<3> a = p - shift - origin, b = q - shift - origin, c = r - shift - origin;
        const double sixfold = sign * a.dot(b.cross(c));
        shape.volume += sixfold / 6.0;
        shape.centroid += sixfold / 24.0 * (a + b + c);
      });
    }
  }
  shape.centroid = origin + shape.centroid / shape.volume;
  return shape;
}

template <int D> void gradient_weights(const Vec<D>* d, std::size_t n, std::array<double, D>* c)
{
  Eigen::Matrix<double, D, D> m = Eigen::Matrix<double, D, D>::Zero();
  for (std::size_t k = 0; k < n; ++k) m += d[k] * d[k].transpose() / d[k].squaredNorm();
  Eigen::Matrix<double, D, D> inverse;
  const double trace = m.trace() / D;
  if (m.determinant() > 1e-8 * std::pow(trace, D)) {
    inverse = m.inverse();
  } else { // a row of cells, a corner: no gradient across
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, D, D>> eigen(m);
    inverse.setZero();
    for (int i = 0; i < D; ++i)
      if (eigen.eigenvalues()[i] > 1e-6 * trace)
        inverse += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose() / eigen.eigenvalues()[i];
  }
  for (std::size_t k = 0; k < n; ++k) {
    const Vec<D> weight = inverse * d[k] / d[k].squaredNorm();
    for (int i = 0; i < D; ++i) c[k][static_cast<std::size_t>(i)] = weight[i];
  }
}

template <int D> void Geometry<D>::resize(const Mesh<D>& mesh, bool is_second_order)
{
  volume.resize(mesh.n_cells);
  centroid.resize(mesh.n_cells);
  planes.resize(mesh.n_faces);
  offsets.resize(is_second_order ? mesh.n_faces : 0);
  weights.resize(is_second_order ? mesh.stencil.size() : 0);
}

template <int D>
BadCellShape update_cells(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end,
                          Geometry<D>& geometry)
{
  BadCellShape bad;
  for (std::size_t c = begin; c < end; ++c) {
    const auto shape = cell_shape(mesh, x, c);
    geometry.volume[c] = shape.volume;
    geometry.centroid[c] = shape.centroid;
    if (bad.cell < 0 && !(shape.volume > 0.0)) bad = {static_cast<Index>(c), shape.volume};
  }
  return bad;
}

template <int D>
void update_reconstruction(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end,
                           Geometry<D>& geometry)
{
  const auto first = static_cast<std::size_t>(mesh.face_begin[begin]);
  const auto last = static_cast<std::size_t>(mesh.face_begin[end]);
  std::size_t owner = begin;
  for (std::size_t f = first; f < last; ++f) {
    while (static_cast<std::size_t>(mesh.face_begin[owner + 1]) <= f) ++owner;
    const Vec<D> middle = middle_of<D>(mesh.face_nodes[f], x);
    const Vec<D> from_owner = middle - geometry.centroid[owner];
    Vec<D> from_neighbour = Vec<D>::Zero();
    if (const Index n = mesh.neighbour[f]; n >= 0) {
      from_neighbour = middle - geometry.centroid[static_cast<std::size_t>(n)];
      if (mesh.is_periodic()) from_neighbour -= mesh.shifts[mesh.face_shift[f]];
    }
    for (int i = 0; i < D; ++i) {
      geometry.offsets[f][0][static_cast<std::size_t>(i)] = from_owner[i];
      geometry.offsets[f][1][static_cast<std::size_t>(i)] = from_neighbour[i];
    }
  }
  std::vector<Vec<D>> d;
  for (std::size_t c = begin; c < end; ++c) {
    stencil_distances(
        mesh, c, [&](std::size_t i) { return geometry.centroid[i]; }, d);
    gradient_weights<D>(d.data(), d.size(), geometry.weights.data() + mesh.stencil_begin[c]);
  }
}

template <int D> FacePlane<D> plane_of(const Vec<D>& area, double volume_rate)
{
  FacePlane<D> plane;
  plane.area = area.norm();
  for (int i = 0; i < D; ++i) plane.normal[static_cast<std::size_t>(i)] = area[i] / plane.area;
  plane.speed = volume_rate / plane.area;
  return plane;
}

template <int D>
void update_planes(const Mesh<D>& mesh, const Nodes<D>& x, std::size_t begin, std::size_t end, Geometry<D>& geometry)
{
  for (auto f = static_cast<std::size_t>(mesh.face_begin[begin]); f < static_cast<std::size_t>(mesh.face_begin[end]);
       ++f)
    geometry.planes[f] = plane_of<D>(area_of<D>(mesh.face_nodes[f], x), 0.0);
}

template CellShape<2> cell_shape(const Mesh<2>&, const Nodes<2>&, std::size_t);
template CellShape<3> cell_shape(const Mesh<3>&, const Nodes<3>&, std::size_t);
template void gradient_weights<2>(const Vec<2>*, std::size_t, std::array<double, 2>*);
template void gradient_weights<3>(const Vec<3>*, std::size_t, std::array<double, 3>*);
template struct Geometry<2>;
template struct Geometry<3>;
template BadCellShape update_cells(const Mesh<2>&, const Nodes<2>&, std::size_t, std::size_t, Geometry<2>&);
template BadCellShape update_cells(const Mesh<3>&, const Nodes<3>&, std::size_t, std::size_t, Geometry<3>&);
template void update_reconstruction(const Mesh<2>&, const Nodes<2>&, std::size_t, std::size_t, Geometry<2>&);
template void update_reconstruction(const Mesh<3>&, const Nodes<3>&, std::size_t, std::size_t, Geometry<3>&);
template void update_planes(const Mesh<2>&, const Nodes<2>&, std::size_t, std::size_t, Geometry<2>&);
template void update_planes(const Mesh<3>&, const Nodes<3>&, std::size_t, std::size_t, Geometry<3>&);
template FacePlane<2> plane_of(const Vec<2>&, double);
template FacePlane<3> plane_of(const Vec<3>&, double);

} // namespace mullion::euler
